//! Why there is no animation.

use std::io;

use thiserror::Error;

/// Why an animation was not written. What stood at its place is as it was.
#[derive(Debug, Error)]
pub enum AnimationError {
    /// The run has neither vehicles nor a building to draw.
    #[error("there is nothing to animate: the run has neither vehicles nor rooms")]
    Nothing,
    /// An encoder refused.
    #[error("cannot encode the animation: {0}")]
    Encoding(Box<dyn std::error::Error + Send + Sync>),
    /// The program that makes films failed.
    #[error("cannot make the film: {0}")]
    Film(io::Error),
    /// The file cannot be written.
    #[error("cannot write the animation {}: {reason}; choose another place for it", path.display())]
    Unwritable {
        /// Path of the file.
        path: std::path::PathBuf,
        /// The system's reason.
        reason: io::Error,
    },
}

impl AnimationError {
    /// An encoder's refusal.
    pub(super) fn encoding(error: impl std::error::Error + Send + Sync + 'static) -> AnimationError {
        AnimationError::Encoding(Box::new(error))
    }
}
