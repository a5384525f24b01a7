//! What the tests of a wrong world look at.

use crate::identify::state_space::likelihood::{Filtered, Observations};
use crate::identify::state_space::selection::Fit;
use crate::identify::telemetry::Telemetry;

/// A fit, and what it is judged by.
pub(in crate::identify::state_space) struct World<'a> {
    pub telemetry: &'a Telemetry,
    pub observations: &'a Observations,
    pub fit: &'a Fit,
    pub filtered: &'a Filtered,
}
