//! The settings of the conservative planner in a scenario file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::prediction::Prediction;
use crate::trajectory::HomotopySearch;

/// The conservative baseline (eq. 6.13).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
    /// What the others are expected to do.
    pub prediction: Prediction,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { passing_orders: HomotopySearch::Classes, prediction: Prediction::Plan }
    }
}
