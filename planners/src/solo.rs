//! Plans of one vehicle: the starting guess is the last plan.

use crate::trajectory::{DescentError, Optimiser, Optimum, Problem, Robust};
use crate::{PlanEvent, Trajectory};

/// An optimum with the problem that it solves.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub problem: Problem,
    pub optimum: Optimum,
    /// Why another problem was solved than the one that was posed; `None` if it is the same.
    pub event: Option<PlanEvent>,
}

/// Solves a problem from the last plan, shifted by one step, and compares the passing orders.
///
/// # Errors
/// [`DescentError`] if no class of motion has an optimum.
pub(crate) fn solve(
    optimiser: &mut Optimiser<Robust>,
    problem: Problem,
    last: Option<&Trajectory>,
) -> Result<Solved, DescentError> {
    let keep = last.map_or_else(Vec::new, Trajectory::later_inputs);
    let optimum = optimiser.optimise(&problem, &[keep])?;
    Ok(Solved { problem, optimum, event: None })
}
