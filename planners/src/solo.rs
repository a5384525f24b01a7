//! Plans of one vehicle: the starting guesses are the last plan and, if that gives no optimum, full braking and full
//! acceleration.

use crate::predict::steady;
use crate::trajectory::{DescentError, Optimiser, Optimum, Problem, Robust};
use crate::{Input, PlanEvent, Scene, Trajectory};

/// An optimum with the problem that it solves.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub problem: Problem,
    pub optimum: Optimum,
    /// Why another problem was solved than the one that was posed; `None` if it is the same.
    pub event: Option<PlanEvent>,
}

/// Solves a problem from the last plan, shifted by one step.
///
/// If that fails or ends on a violated safety ellipse or road edge, and every `look_around_every` steps (0: never), it also
/// starts from full braking and full acceleration. Returns the cheapest optimum.
///
/// # Errors
/// [`DescentError`] if no starting guess leads to an optimum.
pub(crate) fn solve(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    problem: Problem,
    last: Option<&Trajectory>,
    look_around_every: usize,
) -> Result<Solved, DescentError> {
    let look_around = look_around_every > 0 && scene.tick.is_multiple_of(look_around_every);
    let optimum = optimiser.best_of(&problem, &guesses(scene, last), look_around)?;
    Ok(Solved { problem, optimum, event: None })
}

/// Full braking and full acceleration, both without steering.
pub(crate) fn extremes(scene: &Scene) -> [Vec<Input>; 2] {
    let limits = &scene.ego.limits;
    [limits.acceleration_min_mps2, limits.acceleration_max_mps2]
        .map(|acceleration| steady(&scene.ego.state, acceleration, limits, scene.horizon, scene.step_s))
}

/// The last plan shifted by one step, full braking, and full acceleration.
fn guesses(scene: &Scene, last: Option<&Trajectory>) -> [Vec<Vec<Input>>; 3] {
    let keep = last.map_or_else(Vec::new, Trajectory::later_inputs);
    let [brake, accelerate] = extremes(scene);
    [vec![keep], vec![brake], vec![accelerate]]
}
