//! Deadlines of plans, measured by the work that a plan took, so that the result is the same on every machine.

use crate::PlanError;
use crate::trajectory::Statistics;

/// The most work that a plan may take. A plan that took more is discarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanDeadline {
    most_work: usize,
}

impl PlanDeadline {
    /// Units of [work](Statistics::work) that a millisecond stands for. A unit took 10 to 35 µs for the planners and machine of
    /// `docs/evidence/benchmarks.md`.
    const WORK_PER_MS: f64 = 50.0;

    /// The deadline after this time \[ms\], converted to the work that the reference machine does in it; at least one unit of work.
    pub fn after_ms(budget_ms: f64) -> Self {
        PlanDeadline { most_work: (budget_ms * PlanDeadline::WORK_PER_MS).round().max(1.0) as usize }
    }

    /// Checks that the work behind a plan stayed within the deadline.
    ///
    /// # Errors
    /// [`PlanError::Late`] if it did not.
    pub fn check(self, done: &Statistics) -> Result<(), PlanError> {
        let (work, most_work) = (done.work(), self.most_work);
        if work <= most_work { Ok(()) } else { Err(PlanError::Late { work, most_work }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_is_late_if_it_takes_more_work_than_its_deadline() {
        let done = |work| Statistics { inner_iterations: work, ..Statistics::default() };
        let deadline = PlanDeadline::after_ms(2.0);
        assert_eq!(deadline.check(&done(100)), Ok(()));
        assert_eq!(deadline.check(&done(101)), Err(PlanError::Late { work: 101, most_work: 100 }));
        assert_eq!(PlanDeadline::after_ms(1e-9).check(&done(1)), Ok(()));
    }
}
