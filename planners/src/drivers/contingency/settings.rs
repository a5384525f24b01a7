//! The settings of the contingency planner in a scenario file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::trajectory::HomotopySearch;

/// A plan that branches: the ego infers what the others may do, decides now what holds for all of it, and has a continuation for
/// each. It knows no other plan; `inference` on the vehicle says how it learns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// What is less likely is not planned for. With 1 only the likeliest is.
    #[schemars(
        range(min = 0.0, max = 1.0),
        extend("x-unit" = "dimensionless"),
        extend("x-mechanism" = { "branches": 1.0 })
    )]
    pub probability_at_least: f64,
    /// Most futures, the likeliest ones.
    #[schemars(range(min = 1, max = 4))]
    pub futures_at_most: usize,
    /// Two plans of another vehicle can be told apart from the moment at which they are this far apart; if they never are, they are
    /// one \[m\].
    #[schemars(range(min = 0.001))]
    pub told_apart_m: f64,
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            probability_at_least: 0.05,
            futures_at_most: 3,
            told_apart_m: 0.05,
            passing_orders: HomotopySearch::Classes,
        }
    }
}
