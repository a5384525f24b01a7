//! Which plans persuasion refers to.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which round of the negotiation the cooperative and the conservative plan of the persuasion constraint are from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum References {
    /// The first: the ego keeps nearer to what it first proposed than to its first fallback, however long it is refused.
    FirstRound,
    /// The one before (eq. 6.23): the ego may fall back by about half of the way in each step.
    #[default]
    LastRound,
}
