//! The settings of the cooperative planner in a scenario file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::prediction::Prediction;
use crate::trajectory::HomotopySearch;

/// The joint problem of all vehicles that have this driver (eq. 6.12).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Divides this vehicle's cost in the joint one, `Z_i` of eq. 6.6: the larger, the more it gives way.
    #[schemars(range(min = 0.000001), extend("x-unit" = "dimensionless"))]
    pub normaliser: f64,
    /// What vehicles that do not cooperate are expected to do.
    pub prediction: Prediction,
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { normaliser: 1.0, prediction: Prediction::Plan, passing_orders: HomotopySearch::Classes }
    }
}
