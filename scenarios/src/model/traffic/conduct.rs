//! How drivers behave where a file says nothing of it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How drivers behave where a file says nothing of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Conduct {
    /// As people on real roads: within comfort, with time gaps and a reaction time, by the rules, and around what stands in the way.
    People,
    /// As the drivers of the source: at once, with all that the vehicle can do, and for studies of who yields.
    Source,
}
