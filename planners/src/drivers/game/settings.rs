//! What a scenario file may say about the persuasion game.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::prospect::ProspectTheory;
use crate::prediction::Prediction;
use crate::trajectory::HomotopySearch;

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

/// Which version of the game is played.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GameForm {
    /// Stakes are bounded such that the accident is the worst outcome, both players give logit replies, and a vehicle is
    /// judged by how much it slows down against its own largest speed.
    #[default]
    Corrected,
    /// Table 8.2 and eq. 8.3, 8.4, 8.8, 8.9 as printed: stakes are ratios, `solution` says how the game is solved, and a
    /// vehicle is judged against the plan of the other.
    AsPrinted,
}

/// By which mean speed the ego expresses its intention, and is thought to be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExpressedSpeed {
    /// The mean of its speeds (eq. 8.13): an ego that may not arrive yet weaves in its lane, to be fast all the same.
    #[default]
    OfStates,
    /// Its way along the road by time, which says when it arrives.
    AlongRoad,
}

/// How sure the other is to be of the ego's intention, once that is expressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExpressedBounds {
    /// At least so sure that the ego passes, if it intends to pass, and at most, if it intends to yield.
    #[default]
    OneSided,
    /// To within `epsilon_p` (eq. 8.11): an ego that is thought to pass for sure slows down, to seem less determined.
    Interval,
}

/// The persuasion game (chapter 8).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Which version of the game is played.
    pub form: GameForm,
    /// How the game is solved in the form `as-printed`.
    pub solution: SolutionConcept,
    /// How random a logit reply is, `τ`, in units of the value of the accident; used in the form `corrected`. Towards 0
    /// replies become best replies.
    #[schemars(range(min = 0.05), extend("x-unit" = "dimensionless"))]
    pub temperature: f64,
    /// The ego's intention before it has observed a vehicle; used in the form `corrected`. An ego that begins at 0.5 never
    /// shows that it could pass, and no driver yields to it.
    #[schemars(range(min = 0.05, max = 0.95), extend("x-unit" = "dimensionless"))]
    pub first_intention: f64,
    /// Share of the way to its reply that the ego's intention goes in a step; used in the form `corrected`. It leaves the other
    /// time to answer before the ego gives up.
    #[schemars(range(min = 0.01, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub damping: f64,
    /// What the accident costs, `M` of Table 8.2. In the form `as-printed`, stakes are ratios of probabilities and reach 19: 2
    /// or 3 on one road, 1 at an intersection; from 50 on both yield. In the form `corrected`, stakes scale with it.
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
    /// Deviation of mean speeds from what is expected, `σ_1` of eq. 8.3; half of it in the form `corrected`, whose means are
    /// half as far apart \[m/s\].
    #[schemars(range(min = 0.001))]
    pub sigma_1_mps: f64,
    /// Typical time that a crossing takes, `T_c` of eq. 8.4 \[s\].
    #[schemars(range(min = 0.001))]
    pub crossing_s: f64,
    /// Deviation of times of arrival from what is expected, `σ_2` of eq. 8.4 \[s\]. At 0.5 the first step decides and the ego
    /// yields for good. Half of it in the form `corrected`, whose means are half as far apart.
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
    /// Whether the ego may seem more determined than it is; in the form `as-printed` it may not.
    pub expressed_bounds: ExpressedBounds,
    /// By which mean speed the ego expresses its intention.
    pub expressed_speed: ExpressedSpeed,
    /// What a mean speed outside the expressed interval costs per m/s and step: 0.5 on one road, 1.5 on a ramp, 50 at an
    /// intersection.
    #[schemars(range(min = 0.0), extend("x-unit" = "s/m"))]
    #[schemars(extend("x-mechanism" = { "expression of intention": 0.0 }))]
    pub slack_weight: f64,
    /// How long the ego expresses its intention to a vehicle that is not the first one it meets; used in the form
    /// `as-printed` \[s\].
    #[schemars(range(min = 0.0))]
    pub later_expression_s: f64,
    /// Time in which the other cannot have answered: until it has passed, its motion does not count as evidence. At least its reaction
    /// time; 0 among drivers who react at once \[s\].
    #[schemars(range(min = 0.0), extend("x-mechanism" = { "time to answer": 0.0 }))]
    pub answer_s: f64,
    /// With a vehicle that is this far ahead in the target lane nothing is left to play for \[m\].
    #[schemars(range(min = 0.0))]
    pub clear_lead_m: f64,
    /// What the others are expected to do.
    pub prediction: Prediction,
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
}

impl Settings {
    /// Whether an intention is expressed to within an interval.
    pub(super) fn expresses_intervals(&self) -> bool {
        self.form == GameForm::AsPrinted || self.expressed_bounds == ExpressedBounds::Interval
    }
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            form: GameForm::Corrected,
            solution: SolutionConcept::LeaderFollower,
            temperature: 0.5,
            first_intention: 0.95,
            damping: 0.1,
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
            expressed_bounds: ExpressedBounds::OneSided,
            expressed_speed: ExpressedSpeed::OfStates,
            slack_weight: 0.5,
            later_expression_s: 2.5,
            answer_s: 0.0,
            clear_lead_m: 0.2,
            prediction: Prediction::Plan,
            passing_orders: HomotopySearch::Classes,
        }
    }
}
