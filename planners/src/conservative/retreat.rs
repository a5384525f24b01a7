//! What other planners do when their own problem leads nowhere: they ask nothing of anybody.

use super::problem;
use crate::solo::{self, Solved};
use crate::trajectory::{DescentError, Optimiser, Problem, Robust};
use crate::{Agent, Scene, Trajectory};

/// The optimum of a problem ([`solo::solve`]), or if there is none, that of the conservative problem.
///
/// # Errors
/// That of the conservative problem.
pub(crate) fn solve_or_retreat(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    problem: Problem,
    last: Option<&Trajectory>,
    look_around_every: usize,
) -> Result<Solved, DescentError> {
    solo::solve(optimiser, scene, problem, last, look_around_every)
        .or_else(|error| retreat(optimiser, scene, last, &error))
}

/// The conservative plan, because of an error.
///
/// # Errors
/// That of the conservative problem.
pub(crate) fn retreat(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    last: Option<&Trajectory>,
    because: &DescentError,
) -> Result<Solved, DescentError> {
    let others: Vec<&Agent> = scene.others.iter().collect();
    let solved = solo::solve(optimiser, scene, problem(scene, &others), last, 0)?;
    Ok(Solved { event: Some(format!("conservative plan: {because}")), ..solved })
}
