//! Why a running world cannot be copied.

use thiserror::Error;

/// Why a running world cannot be copied.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{who} cannot be copied: {why}")]
pub struct NotCopied {
    /// The part of the world.
    pub who: String,
    /// Why the piece of state has no copy.
    pub why: String,
}

impl NotCopied {
    /// The error that the entity of the vehicle called `name` was removed from the world, or lacks one of its initial components.
    pub fn incomplete(name: &str) -> Self {
        NotCopied { who: format!("the vehicle `{name}`"), why: "an added system removed it or a part of it".to_owned() }
    }

    /// The error that the driver of the vehicle called `name` cannot be copied.
    pub fn driver_of(name: &str) -> Self {
        NotCopied { who: format!("the driver of `{name}`"), why: "it does not implement `fork`".to_owned() }
    }
}
