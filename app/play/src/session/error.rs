//! Why a session cannot do what it is asked for.

use interplay_simulation::NotCopied;
use interplay_simulation::run::RunError;
use thiserror::Error;

/// Why a session cannot do what it is asked for.
#[derive(Debug, Error)]
pub enum SessionError {
    /// No such vehicle, or nobody could drive it.
    #[error("there is no seat `{seat}`; choose from {seats}")]
    NoSeat {
        /// What was asked for.
        seat: String,
        /// The vehicles that a person can drive.
        seats: String,
    },
    /// There is nobody to drive.
    #[error("`{0}` has no vehicle that a person can drive; `interplay list` shows what there is")]
    NoVehicles(String),
    /// No such planner.
    #[error("there is no planner `{0}` that takes the wheel")]
    NoPlanner(String),
    /// The world cannot go on.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The world cannot be copied.
    #[error(transparent)]
    NotCopied(#[from] NotCopied),
}
