//! The fallback of other planners: the conservative problem, when their own problem has no optimum.

use super::problem;
use crate::drivers::receding_horizon::{self, Solved};
use crate::trajectory::{DescentError, Optimiser, Problem, Robust};
use crate::{Agent, PlanEvent, PlanEventKind, Scene, Trajectory};

/// Solves `problem` ([`receding_horizon::solve`]). If that fails, solves the conservative problem instead.
///
/// # Errors
/// The error of the conservative problem.
pub(crate) fn solve_or_fall_back(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    problem: Problem,
    last: Option<&Trajectory>,
) -> Result<Solved, DescentError> {
    receding_horizon::solve(optimiser, problem, receding_horizon::guess(scene, last))
        .or_else(|error| fall_back(optimiser, scene, last, &error))
}

/// Solves the conservative problem. The event of the result states the error `because` of which it is solved.
///
/// # Errors
/// The error of the conservative problem.
pub(crate) fn fall_back(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    last: Option<&Trajectory>,
    because: &DescentError,
) -> Result<Solved, DescentError> {
    let others: Vec<&Agent> = scene.others.iter().collect();
    let solved =
        receding_horizon::solve_or_improve(optimiser, problem(scene, &others), receding_horizon::guess(scene, last))?;
    let event =
        PlanEvent { kind: PlanEventKind::Fallback(because.to_string()), text: "drives a conservative plan".to_owned() };
    Ok(Solved { event: Some(event), ..solved })
}
