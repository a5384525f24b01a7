//! Numbers of active constraints as diagnostics of a plan.

use crate::plan::diagnostic::{
    Diagnostic, STEPS_AT_EDGE, STEPS_AT_ELLIPSE, STEPS_AT_INPUT_BOUND, STEPS_AT_SPEED_BOUND,
};
use crate::trajectory::activity::Activity;

impl Activity {
    /// The numbers as diagnostics.
    pub(crate) fn diagnostics(&self) -> [Diagnostic; 4] {
        [
            STEPS_AT_ELLIPSE.is(self.safety as f64),
            STEPS_AT_EDGE.is(self.edge as f64),
            STEPS_AT_INPUT_BOUND.is(self.input as f64),
            STEPS_AT_SPEED_BOUND.is(self.speed as f64),
        ]
    }
}
