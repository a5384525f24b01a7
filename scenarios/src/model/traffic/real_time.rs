//! The time limit of plans, and what happens when a plan exceeds it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The time limit of plans of automated vehicles. Drivers that stand for people (`human`, `idm`, `scripted`) are exempt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RealTime {
    /// The longest time of a plan; by default one tick. The report counts the plans that exceeded it by the clock \[ms\].
    #[serde(default)]
    #[schemars(range(min = 0.1, max = 1e6), example = 10.0)]
    pub plan_budget_ms: Option<f64>,
    /// What happens to a plan that exceeds it.
    #[serde(default)]
    pub deadline: Deadline,
}

/// What happens to a plan that exceeds its time limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Deadline {
    /// It is used, and the report counts it.
    #[default]
    Reported,
    /// It counts as failed, and the vehicle uses its fallback. The optimiser's work decides, at 50 units per millisecond
    /// (steps posed and iterations inside them), not the clock: the same file gives the same result on any machine.
    Enforced,
}

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
