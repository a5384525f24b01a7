//! Why a running world cannot be copied.

use thiserror::Error;

/// Why a running world cannot be copied.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{who} cannot be copied: {why}")]
pub struct NotCopied {
    /// Which part of the world it is.
    pub who: String,
    /// Why the piece of state has no copy.
    pub why: String,
}
