//! The reward of an agent, term by term.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Action, AgentView, StartDraw, StreetDraw};

/// Declares the terms of a reward and their weights.
macro_rules! reward_terms {
    ($($(#[doc = $doc:literal])* $term:ident $field:ident = $weight:expr,)*) => {
        /// A term of the reward.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum RewardTerm {
            $($(#[doc = $doc])* $term,)*
        }

        impl RewardTerm {
            /// All terms, in the order in which they are reported.
            pub const ALL: &[RewardTerm] = &[$(RewardTerm::$term),*];

            /// The name of the term.
            pub fn name(self) -> &'static str {
                match self {
                    $(RewardTerm::$term => stringify!($field),)*
                }
            }
        }

        /// The weight of each term of the reward, which is the weighted sum of the terms.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        pub struct RewardWeights {
            $($(#[doc = $doc])* pub $field: f64,)*
        }

        impl Default for RewardWeights {
            fn default() -> Self {
                RewardWeights { $($field: $weight,)* }
            }
        }

        impl RewardWeights {
            /// The weights, in the order of [`RewardTerm::ALL`].
            pub fn to_array(self) -> [f64; RewardTerm::ALL.len()] {
                [$(self.$field),*]
            }
        }
    };
}

reward_terms! {
    /// Distance along the route, relative to that of a second at the desired speed.
    Progress progress = 0.1,
    /// 1 in the step in which the goal is reached.
    Goal goal = 5.0,
    /// 1 in the step in which it touches another vehicle.
    Contact contact = -5.0,
    /// 1 in the step in which a corner leaves the road.
    OffRoad off_road = -5.0,
    /// Number of times that it began to brake with more than 4 m/s².
    HardBraking hard_braking = -0.5,
    /// Time during which it is closer to another vehicle than half the length of its body, weighted by the missing share of that distance.
    Gap gap = -0.5,
    /// Number of rules of the road that it broke.
    RuleBroken rule_broken = -1.0,
    /// Time, weighted by the speed as a share of the desired one, at most 1.
    Speed speed = 0.0,
    /// Sum of the changes of acceleration, as shares of the strongest braking.
    Jerk jerk = 0.0,
    /// Time, weighted by the lateral acceleration as a share of the strongest braking.
    Lateral lateral = 0.0,
    /// Time behind a leader with a time gap below 1 s of a real car, weighted by the missing share of it.
    TimeGap time_gap = 0.0,
    /// Time during which it is astride a line between lanes.
    Astride astride = 0.0,
    /// 1 in the step of a contact in which it is at fault.
    Fault fault = 0.0,
}

/// The values of the terms in one step, in the order of [`RewardTerm::ALL`].
pub(super) type TermValues = [f64; RewardTerm::ALL.len()];

impl RewardWeights {
    /// The reward of a step.
    pub fn sum(&self, terms: &[f64; RewardTerm::ALL.len()]) -> f64 {
        self.to_array().iter().zip(terms).map(|(weight, term)| weight * term).sum()
    }
}

/// Settings of an environment, in addition to its scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EnvironmentSettings {
    /// The vehicles that are driven from outside; if empty, the ego.
    pub agents: Vec<String>,
    /// The views of each agent, in order.
    pub observations: Vec<AgentView>,
    /// The kind of action of each agent.
    pub action: Action,
    /// The weights of the reward.
    pub reward: RewardWeights,
    /// The random draw of each episode's start.
    pub start: StartDraw,
    /// The streets, of which each episode draws one; without them every episode is on the scenario's road.
    pub streets: Option<StreetDraw>,
    /// Interval of decisions \[s\], rounded to plans. By default, meta-actions last half a second of a real car, and other actions one
    /// plan.
    pub decision_s: Option<f64>,
    /// Whether the report of an episode has all measures. Without, worlds are faster, and the report has the contacts and the digest only.
    pub report: bool,
}

impl Default for EnvironmentSettings {
    fn default() -> Self {
        EnvironmentSettings {
            agents: Vec::new(),
            observations: vec![AgentView::Kinematics(Default::default())],
            action: Action::Continuous,
            reward: RewardWeights::default(),
            start: StartDraw::default(),
            streets: None,
            decision_s: None,
            report: true,
        }
    }
}
