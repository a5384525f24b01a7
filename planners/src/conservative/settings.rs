//! The settings of the conservative planner in a scenario file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::predict::Prediction;

/// The conservative baseline (eq. 6.13).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Every how many steps full braking and full acceleration are tried as starting guesses even though the last plan
    /// improved without trouble; 0 tries them only in trouble.
    pub look_around_every: usize,
    /// What the others are expected to do.
    pub prediction: Prediction,
}
