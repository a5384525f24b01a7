//! Errors of a session.

use interplay_simulation::NotCopied;
use interplay_simulation::run::RunError;
use thiserror::Error;

/// Why a request to a session failed.
#[derive(Debug, Error)]
pub enum SessionError {
    /// The vehicle does not exist, or a person cannot drive it.
    #[error("`{seat}` is not a seat; choose from {seats}")]
    NoSeat {
        /// The requested seat.
        seat: String,
        /// The vehicles that a person can drive.
        seats: String,
    },
    /// The scenario has no vehicle for a person.
    #[error("`{0}` has no vehicle that a person can drive; `interplay list` shows all scenarios")]
    NoVehicles(String),
    /// The planner does not exist, or cannot take the wheel.
    #[error("`{0}` is not a planner that can take the wheel")]
    NoPlanner(String),
    /// The simulation failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The simulation cannot be copied.
    #[error(transparent)]
    NotCopied(#[from] NotCopied),
}
