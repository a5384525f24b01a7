//! The fallback of other planners: the conservative problem, when their own problem has no optimum.

use super::problem;
use crate::solo::{self, Solved};
use crate::trajectory::{DescentError, Optimiser, Problem, Robust};
use crate::{Agent, PlanEvent, PlanEventKind, Scene, Trajectory};

/// Solves `problem` ([`solo::solve`]). If that fails, solves the conservative problem instead.
///
/// # Errors
/// The error of the conservative problem.
pub(crate) fn solve_or_retreat(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    problem: Problem,
    last: Option<&Trajectory>,
) -> Result<Solved, DescentError> {
    solo::solve(optimiser, problem, last).or_else(|error| retreat(optimiser, scene, last, &error))
}

/// Solves the conservative problem. The event of the result states the error `because` of which it is solved.
///
/// # Errors
/// The error of the conservative problem.
pub(crate) fn retreat(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    last: Option<&Trajectory>,
    because: &DescentError,
) -> Result<Solved, DescentError> {
    let others: Vec<&Agent> = scene.others.iter().collect();
    let solved = solo::solve_or_improve(optimiser, problem(scene, &others), last)?;
    let event =
        PlanEvent { kind: PlanEventKind::Retreat(because.to_string()), text: "drives a conservative plan".to_owned() };
    Ok(Solved { event: Some(event), ..solved })
}
