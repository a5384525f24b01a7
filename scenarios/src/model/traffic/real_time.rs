//! How long a plan may take, and what happens to one that takes longer.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How long a plan of an automated vehicle may take. Drivers who stand for people (`human`, `idm`, `scripted`) are not held to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RealTime {
    /// How long a plan may take; by default one tick. The report counts the plans that took longer by the clock \[ms\].
    #[serde(default)]
    #[schemars(range(min = 0.1, max = 1e6), example = 10.0)]
    pub plan_budget_ms: Option<f64>,
    /// What happens to a plan that takes longer.
    #[serde(default)]
    pub deadline: Deadline,
}

/// What happens to a plan that takes longer than it may.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Deadline {
    /// It is driven, and the report counts it.
    #[default]
    Reported,
    /// It counts as failed, and the vehicle falls back. What decides is the optimiser's work, of which a millisecond stands for 50
    /// units (steps posed and iterations inside them), and not the clock: the same file gives the same result on any machine.
    Enforced,
}
