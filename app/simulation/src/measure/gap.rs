//! The smallest distance of the ego's footprint to another in a run.

use crate::frame::Frame;

/// The smallest distance so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct SmallestGap {
    /// In metres; none without other vehicles.
    pub smallest_m: Option<f64>,
}

impl SmallestGap {
    /// Takes in one tick.
    pub fn observe(&mut self, frame: &Frame) {
        self.smallest_m = self.smallest_m.into_iter().chain(frame.smallest_gap_m).min_by(f64::total_cmp);
    }
}
