//! The settings of the conservative planner in a scenario file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::predict::Prediction;

/// The conservative baseline (eq. 6.13).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Whether the classes of motion (before or behind another vehicle, to its left or to its right) are compared and the
    /// cheapest one is chosen. Without it a plan stays in the class of the plan before.
    #[schemars(extend("x-mechanism" = { "passing orders": false }))]
    pub passing_orders: bool,
    /// What the others are expected to do.
    pub prediction: Prediction,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { passing_orders: true, prediction: Prediction::Plan }
    }
}
