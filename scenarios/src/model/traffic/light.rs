//! A traffic light as a file states it.

use interplay_planners::road::network::{LightCycle, LightPhase};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::text::name;

/// A traffic light: the lanes at whose ends it stands, and its phases, which repeat for ever. Vehicles that keep the rules obey it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Light")]
pub struct LightConfig {
    /// Its name, unique among lights.
    #[schemars(extend("pattern" = name::pattern()), example = &"north-south")]
    pub name: String,
    /// The lanes at whose ends it stands: all show the same colour.
    #[schemars(length(min = 1, max = 100), example = json!(["south-in", "north-in"]))]
    pub lanes: Vec<String>,
    /// Its phases, in order.
    #[schemars(
        length(min = 1, max = 100),
        example = json!([{ "colour": "green", "duration_s": 20.0 }, { "colour": "amber", "duration_s": 3.0 }, { "colour": "red", "duration_s": 17.0 }])
    )]
    pub phases: Vec<LightPhase>,
    /// When its first phase begins; cycles before it count, too \[s\].
    #[serde(default)]
    #[schemars(range(min = -100_000.0, max = 100_000.0), example = 5.0)]
    pub offset_s: f64,
}

impl LightConfig {
    /// The colour of the light over time.
    pub fn cycle(&self) -> LightCycle {
        LightCycle { phases: self.phases.clone(), offset_s: self.offset_s }
    }
}
