//! Model predictive control (MPC) in a receding horizon: each plan begins at the last one, shifted by one step.

use crate::trajectory::{DescentError, Optimiser, Optimum, Problem, Robust, StageError};
use crate::{Input, PlanError, PlanEvent, Trajectory};

impl From<DescentError> for PlanError {
    fn from(error: DescentError) -> Self {
        match error {
            DescentError::Step { source: StageError::Infeasible { .. }, .. } => {
                PlanError::Infeasible(error.to_string())
            }
            DescentError::Step { step, .. } => PlanError::Unsolved { status: error.to_string(), iterations: step },
            DescentError::NotConverged(ref reached) => {
                let iterations = reached.statistics.programmes;
                PlanError::Unsolved { status: error.to_string(), iterations }
            }
            DescentError::NotBelow { .. } | DescentError::Settled(_) => {
                PlanError::Unsolved { status: error.to_string(), iterations: 0 }
            }
            DescentError::NotFinite => PlanError::BadInput(error.to_string()),
        }
    }
}

/// An optimum with the problem that it solves.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub problem: Problem,
    pub optimum: Optimum,
    /// Why another problem was solved than the one that was posed; `None` if it is the same.
    pub event: Option<PlanEvent>,
}

/// Solves a problem from the last plan, shifted by one step, and compares the homotopy classes.
///
/// # Errors
/// [`DescentError`] if no homotopy class has an optimum.
pub(crate) fn solve(
    optimiser: &mut Optimiser<Robust>,
    problem: Problem,
    last: Option<&Trajectory>,
) -> Result<Solved, DescentError> {
    let optimum = optimiser.optimise(&problem, &[guess(last)])?;
    Ok(Solved { problem, optimum, event: None })
}

/// The same for whoever has no other problem to fall back on ([`Optimiser::optimise_or_improve`]).
///
/// # Errors
/// [`DescentError`] if the last plan cannot be made better.
pub(crate) fn solve_or_improve(
    optimiser: &mut Optimiser<Robust>,
    problem: Problem,
    last: Option<&Trajectory>,
) -> Result<Solved, DescentError> {
    let optimum = optimiser.optimise_or_improve(&problem, &[guess(last)])?;
    Ok(Solved { problem, optimum, event: None })
}

/// The last plan, one step later.
fn guess(last: Option<&Trajectory>) -> Vec<Input> {
    last.map_or_else(Vec::new, Trajectory::later_inputs)
}
