//! The settings of the Nash planner in a scenario file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::prediction::Prediction;
use crate::trajectory::HomotopySearch;

/// A general-sum game of 2 to 4 vehicles: each minimises its own cost, and none may collide.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Divides the costs that the ego supposes the others to have. Of several equilibria, a larger number chooses one in which the
    /// others give way more.
    #[schemars(range(min = 0.000001), extend("x-unit" = "dimensionless"))]
    pub other_normaliser: f64,
    /// Most vehicles that play, the ego included: the nearest with which something is left to settle. The ego keeps out of the
    /// predicted ways of all others.
    #[schemars(range(min = 2, max = 4))]
    pub players_at_most: usize,
    /// A vehicle that does nothing of what is expected of it for this many steps in a row does not play any more: it is an obstacle on
    /// its predicted way.
    #[schemars(range(min = 1), extend("x-mechanism" = { "refusals": 1_000_000 }))]
    pub patience_steps: usize,
    /// A vehicle that is this far ahead in the target lane does not play \[m\].
    #[schemars(range(min = 0.0))]
    pub clear_lead_m: f64,
    /// How the others are predicted: where their motions lead is what they are supposed to want.
    pub prediction: Prediction,
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            other_normaliser: 1.0,
            players_at_most: 4,
            patience_steps: 5,
            clear_lead_m: 0.2,
            prediction: Prediction::ConstantVelocity,
            passing_orders: HomotopySearch::Classes,
        }
    }
}
