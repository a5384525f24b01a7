//! References to lanes in a file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
