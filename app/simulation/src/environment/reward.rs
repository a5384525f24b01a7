//! What an agent's motion is worth, term by term.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Names the terms of a reward, and makes the weights of them.
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

            /// The word for it.
            pub fn name(self) -> &'static str {
                match self {
                    $(RewardTerm::$term => stringify!($field),)*
                }
            }
        }

        /// What each term of the reward weighs; the reward is the sum of the terms, each times its weight.
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
    /// Way along the route, as a share of what the wanted speed would be in a second; 1 after a second at that speed.
    Progress progress = 0.1,
    /// 1 in the step in which the goal is reached.
    Goal goal = 5.0,
    /// 1 in the step in which it touches somebody.
    Contact contact = -5.0,
    /// 1 in the step in which a corner leaves the road.
    OffRoad off_road = -5.0,
    /// How often it began to brake with more than 4 m/s².
    HardBraking hard_braking = -0.5,
    /// Time for which it is nearer to somebody than half the length of its body, each second times the share of that which is missing.
    Gap gap = -0.5,
    /// How many rules of the road it broke.
    RuleBroken rule_broken = -1.0,
}

/// The values of the terms in one step, in the order of [`RewardTerm::ALL`].
pub(super) type TermValues = [f64; RewardTerm::ALL.len()];

impl RewardWeights {
    /// The reward of a step.
    pub fn sum(&self, terms: &[f64; RewardTerm::ALL.len()]) -> f64 {
        self.to_array().iter().zip(terms).map(|(weight, term)| weight * term).sum()
    }
}
