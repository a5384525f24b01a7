//! Why an environment cannot be made, or a call to it fails.

use thiserror::Error;

use crate::simulation::run_error::RunError;

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
    /// A saved episode goes otherwise when it is repeated.
    #[error(
        "the episode goes otherwise in this program: it was saved by another version, or a file of its scenario has changed"
    )]
    OtherEpisode,
    /// The simulation failed.
    #[error(transparent)]
    Run(#[from] RunError),
}
