//! What is chosen of an environment beside its scenario.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Action, AgentView, RewardWeights, StartDraw};
use crate::simulation::run_error::RunError;

/// What is chosen of an environment beside its scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EnvironmentSettings {
    /// The vehicles that are driven from outside; without any, the ego.
    pub agents: Vec<String>,
    /// What each agent sees, one after the other.
    pub observations: Vec<AgentView>,
    /// What each agent decides.
    pub action: Action,
    /// What the reward is made of.
    pub reward: RewardWeights,
    /// What is drawn anew for every episode.
    pub start: StartDraw,
    /// Time from one decision to the next \[s\], rounded to plans; without it every plan of meta-actions is kept for half a second of a real
    /// car, and any other is made anew.
    pub decision_s: Option<f64>,
}

impl Default for EnvironmentSettings {
    fn default() -> Self {
        EnvironmentSettings {
            agents: Vec::new(),
            observations: vec![AgentView::Kinematics(Default::default())],
            action: Action::Continuous,
            reward: RewardWeights::default(),
            start: StartDraw::default(),
            decision_s: None,
        }
    }
}

/// Why there is no such environment, or why it cannot do what it is asked for.
#[derive(Debug, Error)]
pub enum EnvironmentError {
    /// A setting does not fit.
    #[error("`{setting}`: {reason}")]
    Setting {
        /// The setting.
        setting: &'static str,
        /// What is wrong with it, and what would work.
        reason: String,
    },
    /// The scenario has no vehicles.
    #[error("the scenario has no vehicles; `interplay/Building-v0` is the environment of buildings")]
    NoVehicles,
    /// An action is not one.
    #[error("the action of `{agent}` {reason}")]
    Action {
        /// Whose action.
        agent: String,
        /// What is wrong with it, and what would work.
        reason: String,
    },
    /// A list has not as many entries as needed.
    #[error("{what}: {found} numbers, and {wanted} are needed")]
    Length {
        /// What the numbers are.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many are needed.
        wanted: usize,
    },
    /// There is no episode that could go on.
    #[error("the episode is over, or none has begun: call reset")]
    Over,
    /// The simulation cannot go on.
    #[error(transparent)]
    Run(#[from] RunError),
}
