//! The level of detail of traffic far from the ego, as a file states it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Level of detail: a `human` far from the ego follows the intelligent driver model, which costs a hundredth of a plan, and becomes a
/// human again, with a new plan, when it comes near. Each change is an event of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Detail {
    /// Within this distance of the ego, all vehicles drive as their `driver` says. A vehicle that has come within it counts as near up to a
    /// distance a tenth larger \[m\].
    #[schemars(range(min = 0.1, max = 100_000.0), example = 150.0)]
    pub within_m: f64,
}
