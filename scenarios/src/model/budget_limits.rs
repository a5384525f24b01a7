//! The limits that a scenario file may raise.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The limits on the work of a run; a run above them is refused before it begins. The defaults allow some minutes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BudgetLimits {
    /// The most plans: one for each vehicle at each tick.
    #[schemars(range(min = 1))]
    pub plans: u64,
    /// The most steps: of each vehicle and each pair of vehicles in each sub-step of the plant, and of each zone of a building.
    #[schemars(range(min = 1))]
    pub steps: u64,
    /// The most operations of the designs of the building's days, estimated, in thousands of millions.
    #[schemars(range(min = 1))]
    pub design_gop: u64,
    /// The longest estimated time on one core of the reference machine \[s\].
    #[schemars(range(min = 1))]
    pub processor_s: u64,
    /// The largest estimated size of the recording \[MB\].
    #[schemars(range(min = 1))]
    pub recorded_mb: u64,
}

impl Default for BudgetLimits {
    fn default() -> Self {
        BudgetLimits { plans: 200_000, steps: 20_000_000, design_gop: 200, processor_s: 1800, recorded_mb: 500 }
    }
}
