//! Settings of an environment, in addition to its scenario.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Action, AgentView, RewardWeights, StartDraw};
use crate::simulation::run_error::RunError;

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
    /// Interval of decisions \[s\], rounded to plans. By default, meta-actions last half a second of a real car, and other actions one
    /// plan.
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

/// Why an environment cannot be made, or a call to it fails.
#[derive(Debug, Error)]
pub enum EnvironmentError {
    /// A setting is invalid.
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
    /// An action is invalid.
    #[error("the action of `{agent}` {reason}")]
    Action {
        /// The agent.
        agent: String,
        /// What is wrong with it, and what would work.
        reason: String,
    },
    /// A list has the wrong length.
    #[error("{what}: {found} numbers, and {wanted} are needed")]
    Length {
        /// What the numbers are.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The required length.
        wanted: usize,
    },
    /// No episode is in progress.
    #[error("the episode is over, or none has begun: call reset")]
    Over,
    /// The simulation failed.
    #[error(transparent)]
    Run(#[from] RunError),
}
