//! References to lanes in a file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::text::name;

/// A lane: of parallel lanes its number, counted from the right, of a network its name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum LaneReference {
    /// Its number; 0 is the rightmost.
    Number(usize),
    /// Its name.
    Name(String),
}

impl LaneReference {
    /// The number of a lane of parallel lanes.
    pub fn number(&self) -> Option<usize> {
        match self {
            LaneReference::Number(number) => Some(*number),
            LaneReference::Name(_) => None,
        }
    }

    /// The name of a lane of a network.
    pub fn name(&self) -> Option<&str> {
        match self {
            LaneReference::Number(_) => None,
            LaneReference::Name(name) => Some(name),
        }
    }
}

impl From<usize> for LaneReference {
    fn from(number: usize) -> Self {
        LaneReference::Number(number)
    }
}

impl From<&str> for LaneReference {
    fn from(name: &str) -> Self {
        LaneReference::Name(name.to_owned())
    }
}

/// A line across some lanes that counts the vehicles that pass it, lane by lane and together. `interplay run --detectors FILE` writes the
/// counts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Detector")]
pub struct DetectorConfig {
    /// Its name, unique among detectors.
    #[schemars(extend("pattern" = name::pattern()), example = &"exit")]
    pub name: String,
    /// The lanes, by name or number.
    #[schemars(length(min = 1, max = 100), example = json!(["main-1", "main-2"]))]
    pub lanes: Vec<LaneReference>,
    /// Its position on each of the lanes \[m\].
    #[schemars(range(min = -100_000.0, max = 100_000.0), example = 150.0)]
    pub along_m: f64,
    /// The length of the intervals over which its counts are written \[s\].
    #[serde(default = "interval_s")]
    #[schemars(range(min = 0.1, max = 100_000.0))]
    pub interval_s: f64,
    /// The upstream detector from which travel times are measured; by default they are not measured.
    #[serde(default)]
    #[schemars(example = &"entry")]
    pub after: Option<String>,
}

fn interval_s() -> f64 {
    60.0
}
