//! What a scenario file may say about the persuasion game.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::prospect::ProspectTheory;
use crate::predict::Prediction;

/// How the game is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SolutionConcept {
    /// The ego leads and the other follows: the source's procedure (eq. 8.8, 8.9).
    #[default]
    LeaderFollower,
    /// A mixed equilibrium: neither gains by deviating alone.
    Nash,
}

/// The persuasion game (chapter 8).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// How the game is solved.
    pub solution: SolutionConcept,
    /// What the accident costs, `M` of Table 8.2. Stakes are ratios of probabilities and reach 19: 2 or 3 on one road, 1 at an
    /// intersection; from 50 on both yield.
    #[schemars(range(min = 0.001), extend("x-unit" = "dimensionless"))]
    pub accident: f64,
    /// How people value uncertain outcomes.
    #[schemars(extend("x-mechanism" = { "prospect theory": ProspectTheory::EXPECTED }))]
    pub prospect: ProspectTheory,
    /// Distance that a vehicle keeps when the manoeuvre is done, `d_s` of eq. 8.3 \[m\].
    #[schemars(range(min = 0.001))]
    pub safety_gap_m: f64,
    /// Typical time that the manoeuvre takes, `t_f` of eq. 8.3 \[s\].
    #[schemars(range(min = 0.001))]
    pub finish_s: f64,
    /// Deviation of mean speeds from what is expected, `σ_1` of eq. 8.3 \[m/s\].
    #[schemars(range(min = 0.001))]
    pub sigma_1_mps: f64,
    /// Typical time that a crossing takes, `T_c` of eq. 8.4 \[s\].
    #[schemars(range(min = 0.001))]
    pub crossing_s: f64,
    /// Deviation of times of arrival from what is expected, `σ_2` of eq. 8.4 \[s\]. At 0.5 the first step decides and the ego
    /// yields for good.
    #[schemars(range(min = 0.001))]
    pub sigma_2_s: f64,
    /// How far before the crossing of the two paths the conflict zone begins \[m\].
    #[schemars(range(min = 0.0))]
    pub conflict_edge_m: f64,
    /// Below this speed a vehicle stands still, `ε_v` of eq. 8.2 \[m/s\].
    #[schemars(range(min = 0.000001))]
    pub standstill_mps: f64,
    /// Latest time of arrival, `T_max` of eq. 8.2 \[s\].
    #[schemars(range(min = 0.001))]
    pub arrival_max_s: f64,
    /// Share of the way to ½ that beliefs fade in a step.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    #[schemars(extend("x-mechanism" = { "forgetting": 0.0 }))]
    pub forgetting: f64,
    /// Width of the interval of intentions that the ego expresses, `ε_p` of eq. 8.11.
    #[schemars(range(min = 0.0, max = 0.9), extend("x-unit" = "dimensionless"))]
    pub epsilon_p: f64,
    /// What a mean speed outside the expressed interval costs per m/s and step: 0.5 on one road, 1.5 on a ramp, 50 at an
    /// intersection.
    #[schemars(range(min = 0.0), extend("x-unit" = "s/m"))]
    #[schemars(extend("x-mechanism" = { "expression of intention": 0.0 }))]
    pub slack_weight: f64,
    /// How long the ego expresses its intention to a vehicle that is not the first one it meets \[s\].
    #[schemars(range(min = 0.0))]
    pub later_expression_s: f64,
    /// With a vehicle that is this far ahead in the target lane nothing is left to play for \[m\].
    #[schemars(range(min = 0.0))]
    pub clear_lead_m: f64,
    /// What the others are expected to do.
    pub prediction: Prediction,
    /// Whether the classes of motion (before or behind another vehicle, to its left or to its right) are compared and the
    /// cheapest one is chosen. Without it a plan stays in the class of the plan before.
    #[schemars(extend("x-mechanism" = { "passing orders": false }))]
    pub passing_orders: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            solution: SolutionConcept::LeaderFollower,
            accident: 2.0,
            prospect: ProspectTheory::default(),
            safety_gap_m: 1.5,
            finish_s: 5.0,
            sigma_1_mps: 0.8,
            crossing_s: 1.0,
            sigma_2_s: 2.0,
            conflict_edge_m: 0.3,
            standstill_mps: 0.05,
            arrival_max_s: 20.0,
            forgetting: 0.1,
            epsilon_p: 0.05,
            slack_weight: 0.5,
            later_expression_s: 2.5,
            clear_lead_m: 0.2,
            prediction: Prediction::Plan,
            passing_orders: true,
        }
    }
}
