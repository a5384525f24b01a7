//! The default behaviour of drivers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The default behaviour of drivers, for keys that the file does not state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Conduct {
    /// Like people on real roads: within comfort, with time gaps and a reaction time, by the rules, and around obstacles in the way.
    People,
    /// Like the drivers of the dissertation: without delay, with all that the vehicle can do, for studies of yielding.
    Source,
}
