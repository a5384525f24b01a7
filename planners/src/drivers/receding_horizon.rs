//! Model predictive control (MPC) in a receding horizon: each plan begins at the last one, shifted by one step.

use crate::trajectory::{DescentError, Optimiser, Optimum, Problem, Robust, StageError};
use crate::{Input, PlanError, PlanEvent, Scene, Trajectory};

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

/// Solves a problem from a guess ([`guess`]) and compares the homotopy classes.
///
/// # Errors
/// [`DescentError`] if no homotopy class has an optimum.
pub(crate) fn solve(
    optimiser: &mut Optimiser<Robust>,
    problem: Problem,
    guess: Vec<Input>,
) -> Result<Solved, DescentError> {
    let optimum = optimiser.optimise(&problem, &[guess])?;
    Ok(Solved { problem, optimum, event: None })
}

/// The same for drivers without another problem to fall back on ([`Optimiser::optimise_or_improve`]).
///
/// # Errors
/// [`DescentError`] if the last plan cannot be made better.
pub(crate) fn solve_or_improve(
    optimiser: &mut Optimiser<Robust>,
    problem: Problem,
    guess: Vec<Input>,
) -> Result<Solved, DescentError> {
    let optimum = optimiser.optimise_or_improve(&problem, &[guess])?;
    Ok(Solved { problem, optimum, event: None })
}

/// From where a descent begins: the last plan, one step later; or past an obstacle that is passed now, if the last plan stays behind it.
pub(crate) fn guess(scene: &Scene, last: Option<&Trajectory>) -> Vec<Input> {
    let Some(last) = last else { return Vec::new() };
    let passed = scene.ego.rules.passes.as_ref().filter(|obstacle| obstacle.keeps_back(scene, last));
    passed.map_or_else(|| last.later_inputs(), |obstacle| obstacle.guess(scene))
}
