//! What a scenario file may say about the Bayesian planner.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::prediction::Prediction;
use crate::trajectory::HomotopySearch;

/// Which value of the other's best reply enters the ego's cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ReplyValue {
    /// `k_1 ω`, as the source: attracts, the more the readier the other is to change its plan.
    #[default]
    Linear,
    /// `−A w_4/(A − w_4) ω²`, which follows from eq. 7.8 and 7.18: repels. Such an ego stops or never merges; it is here to
    /// show the difference. `w_1` is then at least `w_4`, as the source requires.
    Exact,
}

/// Bayesian persuasion (chapter 7).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Smallest weight that the other is believed to put on its own plan, `w_1` of eq. 7.8.
    #[schemars(range(min = 0.001), extend("x-unit" = "dimensionless"))]
    pub w_1_min: f64,
    /// Largest weight that the other is believed to put on its own plan.
    #[schemars(range(min = 0.001), extend("x-unit" = "dimensionless"))]
    pub w_1_max: f64,
    /// Weight of the other's wish to keep away from the ego, `w_4` of eq. 7.8; at most `w_1_min`, by the source's condition
    /// `w_1 ⪰ w_4`. At 0 the ego does not persuade; from 2 on it follows the other too closely to pass first.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    #[schemars(extend("x-mechanism" = { "persuasion": 0.0 }))]
    pub w_4: f64,
    /// Mean change of the other's plan at which its believed `w_1` has fallen to 1/e of its range, `β_0` \[m\].
    #[schemars(range(min = 0.000001))]
    pub beta_0_m: f64,
    /// Variance of the signal per mean change `α` of the ego's own plan (eq. 7.27).
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub variance_per_change: f64,
    /// Largest variance of the signal.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub variance_max: f64,
    /// Variance of the other's belief about `ω`, `Σ_ω`; below 0.2 for eq. 7.17. Only the exact value depends on it.
    #[schemars(range(min = 0.0, max = 0.2), extend("x-unit" = "dimensionless"))]
    pub impression_variance: f64,
    /// Which value of the other's best reply enters the ego's cost.
    pub value: ReplyValue,
    /// Share of the squared distance along the other's road that counts where the ego expects to be ahead of the other; 1 as
    /// printed, where the ego falls back for the sake of a bold signal and loses places in ramp merges and roundabouts.
    #[schemars(range(min = 0.001, max = 1.0), extend("x-unit" = "dimensionless"))]
    #[schemars(extend("x-mechanism" = { "keeping its lead": 1.0 }))]
    pub ahead_share: f64,
    /// Time in which the other cannot have answered: until it has passed, its motion does not count as evidence. At least its reaction
    /// time; 0 among drivers who react at once \[s\].
    #[schemars(range(min = 0.0), extend("x-mechanism" = { "time to answer": 0.0 }))]
    pub answer_s: f64,
    /// A vehicle that is this far ahead in the target lane is not persuaded any more \[m\].
    #[schemars(range(min = 0.0))]
    pub clear_lead_m: f64,
    /// What the others are expected to do.
    pub prediction: Prediction,
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            w_1_min: 1.0,
            w_1_max: 20.0,
            w_4: 1.0,
            beta_0_m: 0.01,
            variance_per_change: 0.5,
            variance_max: 0.05,
            impression_variance: 0.1,
            value: ReplyValue::Linear,
            ahead_share: 0.3,
            answer_s: 0.0,
            clear_lead_m: 0.2,
            prediction: Prediction::Plan,
            passing_orders: HomotopySearch::Classes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DriverKind;

    /// The source's condition `w_1 ⪰ w_4`.
    #[test]
    fn the_weight_of_keeping_away_is_at_most_that_of_the_own_plan() {
        let with =
            |w_1_min, w_4| Settings { w_1_min, w_4, ..Settings::default() }.check(30).map_err(|error| error.key());
        assert_eq!(with(1.0, 1.0), Ok(()));
        assert_eq!(with(1.0, 1.1), Err("w_4"));
        assert_eq!(with(30.0, 1.0), Err("w_1_min"));
    }
}
