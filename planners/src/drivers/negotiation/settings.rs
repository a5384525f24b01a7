//! What a scenario file may say about the negotiation planner.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::acceptance::Acceptance;
use super::references::References;
use crate::prediction::Prediction;
use crate::trajectory::HomotopySearch;

/// What concession changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Concedes {
    /// The weight of the ego's cost in its problem, as printed: the less it counts, the more the ego accelerates to get out of the
    /// other's way.
    #[default]
    Cost,
    /// The choice between going first and going behind: the conceded weight compares the proposal with the conservative plan, and the
    /// ego drives the latter once it is the cheaper one, and asks no more; among people it may ask once more after 3 s. Within its way it drives as if it had conceded nothing.
    Order,
}

/// Negotiation with concession and persuasion (chapter 6).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// How fast the ego concedes, `β` of eq. 6.18; below 1.
    #[schemars(extend("exclusiveMinimum" = 0.0), extend("exclusiveMaximum" = 1.0), extend("x-unit" = "dimensionless"))]
    pub beta: f64,
    /// How much acceptance strengthens persuasion, `γ` of `α = 1 + γ p_a` (eq. 6.20); 0 or more.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    #[schemars(extend("x-mechanism" = { "reinforcement": 0.0 }))]
    pub gamma: f64,
    /// A rise of the acceptance probability of at most this much counts as no progress, `ε`.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub epsilon: f64,
    /// Steps without progress after which the next vehicle is asked, or none if it was the last.
    #[schemars(range(min = 1))]
    pub patience_steps: usize,
    /// Time in which the other cannot have answered: patience with it, and the price of patience, begin after it. Its reaction time,
    /// one plan and 0.4 s in which the answer shows; 0 among drivers who react at once \[s\].
    #[schemars(range(min = 0.0), extend("x-mechanism" = { "time to answer": 0.0 }))]
    pub answer_s: f64,
    /// By which share the conservative plan may be dearer than the cheapest one since the ego's first request. Where it is
    /// dearer, a vehicle that makes no progress is not asked any more. The source has no such end: with 1000000 the steps alone
    /// count.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    #[schemars(extend("x-mechanism" = { "price of patience": 1e6 }))]
    pub retreat_dearer_at_most: f64,
    /// A vehicle that is this far ahead in the target lane is not asked any more \[m\].
    #[schemars(range(min = 0.0))]
    pub clear_lead_m: f64,
    /// Most vehicles that are asked at once. With 1, the source's way, they are asked one after the other, from the front of the
    /// road to its rear.
    #[schemars(range(min = 1, max = 3))]
    pub partners_at_most: usize,
    /// Steps during which the other is assumed to follow the prediction, `T_n` of eq. 6.15.
    #[schemars(range(min = 1))]
    pub settled_steps: usize,
    /// Normaliser of the ego's cost, `Z_1` of eq. 6.14.
    #[schemars(extend("exclusiveMinimum" = 0.0), extend("x-unit" = "dimensionless"))]
    pub ego_normaliser: f64,
    /// Normaliser of the other's deviation, `Z_2` of eq. 6.14. The deviation that full braking causes over 3 s is of
    /// order 100, so 100 makes both terms of order one at the first tick; at 1 the proposal asks for nothing.
    #[schemars(extend("exclusiveMinimum" = 0.0), extend("x-unit" = "dimensionless"))]
    pub other_normaliser: f64,
    /// Ratio of the ego's cost to the other's deviation, `(w/Z_1) / ((1 − w)/Z_2)`, at which concession ends (eq. 6.18
    /// never lets `w` recover). It begins at `Z_2/Z_1`; below 1 the other's deviation counts more than the ego's cost. 0 is
    /// the printed form, which has no end.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub least_cost_ratio: f64,
    /// What counts as acceptance.
    pub acceptance: Acceptance,
    /// Whether the ego concedes (eq. 6.18); without it the weight of its own cost stays at 0.5.
    #[schemars(extend("x-mechanism" = { "concession": false }))]
    pub concession: bool,
    /// What concession changes.
    pub concedes: Concedes,
    /// Whether the persuasion constraint is imposed (eq. 6.23).
    #[schemars(extend("x-mechanism" = { "persuasion": false }))]
    pub persuasion: bool,
    /// From which round of the negotiation the references of the persuasion constraint are.
    pub references: References,
    /// Whether the negotiated input is applied only if a conservative plan still exists after it.
    #[schemars(extend("x-mechanism" = { "safety filter": false }))]
    pub safety_filter: bool,
    /// Which classes of motion (before or behind another vehicle, to its left or to its right) are compared, of which the
    /// cheapest one is driven.
    #[schemars(extend("x-mechanism" = { "passing orders": HomotopySearch::Off }))]
    pub passing_orders: HomotopySearch,
    /// What the others are expected to do. At constant velocity no vehicle ever seems to accept a proposal.
    pub prediction: Prediction,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            beta: 0.8,
            gamma: 1.0,
            epsilon: 0.01,
            patience_steps: 5,
            answer_s: 0.0,
            retreat_dearer_at_most: 0.1,
            clear_lead_m: 0.2,
            partners_at_most: 1,
            settled_steps: 6,
            ego_normaliser: 1.0,
            other_normaliser: 100.0,
            least_cost_ratio: 0.1,
            acceptance: Acceptance::Willingness,
            concession: true,
            concedes: Concedes::Cost,
            persuasion: true,
            references: References::LastRound,
            safety_filter: true,
            passing_orders: HomotopySearch::Classes,
            prediction: Prediction::Plan,
        }
    }
}

impl Settings {
    /// The weight `w` at which the ratio of the costs is the least one.
    pub(super) fn least_weight(&self) -> f64 {
        let share = self.least_cost_ratio * self.ego_normaliser;
        share / (share + self.other_normaliser)
    }
}
