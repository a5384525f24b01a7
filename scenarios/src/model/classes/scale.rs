//! The scale of a scenario.

use std::borrow::Cow;

use interplay_planners::Body;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// The size of a scenario, as a multiple of 1/10 scale.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ScenarioScale {
    /// A named size.
    Named(NamedScale),
    /// Any ratio of lengths to those of a 1/10 scale car.
    Ratio(f64),
}

/// A named size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NamedScale {
    /// Cars of 0.4 m on lanes of 0.37 m.
    Tenth,
    /// Real cars on real roads.
    Full,
}

/// Full size as a multiple of 1/10 scale.
pub(crate) const FULL_SCALE: f64 = Body::REAL_SCALE;

impl ScenarioScale {
    /// The ratio `λ` of lengths to those of 1/10 scale cars.
    pub fn ratio(self) -> f64 {
        match self {
            ScenarioScale::Named(NamedScale::Tenth) => 1.0,
            ScenarioScale::Named(NamedScale::Full) => FULL_SCALE,
            ScenarioScale::Ratio(ratio) => ratio,
        }
    }
}

impl JsonSchema for ScenarioScale {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "ScenarioScale".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "oneOf": [
                { "type": "string", "const": "tenth", "description": "Cars of 0.4 m on lanes of 0.37 m." },
                { "type": "string", "const": "full", "description": "Real cars on real roads." },
                { "type": "number", "minimum": 0.01, "maximum": 1000.0,
                  "description": "Any ratio of lengths to those of a 1/10 scale car." },
            ]
        })
    }
}
