//! What a descent leaves to the next one, a step later: the multipliers of its optimum and how far its first step went.
//!
//! Rows keep their meaning from one step to the next, but time has moved on: the multiplier of stage `k + 1` is that of stage
//! `k` now. They save a planner that plans anew at every step the cold Gauss-Newton step; the optimum is the same.

use crate::trajectory::stage::{Reach, StageQp, StageSolution};

/// Multipliers and reach of an earlier descent; empty before the first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WarmStart {
    /// The optimum's multipliers; deviations are zero.
    pub multipliers: StageSolution,
    /// How far the descent's first step was expected to go from where it began.
    pub reach: Option<Reach>,
}

impl WarmStart {
    /// Whether there is something to start from for a problem of this shape.
    pub(super) fn fits(&self, qp: &StageQp) -> bool {
        self.multipliers.fits(qp)
    }
}

impl StageSolution {
    /// Moves every stage's multipliers to the stage before; the last one keeps its own.
    pub(super) fn shift_stages(&mut self) {
        self.bound_multipliers.iter_mut().for_each(|bounds| shift(bounds));
        self.row_multipliers.iter_mut().for_each(|rows| shift(rows));
    }
}

fn shift<T: Copy>(stages: &mut [T]) {
    if !stages.is_empty() {
        stages.copy_within(1.., 0);
    }
}
