//! How a vehicle that decides alone finds its plan: from the last one, and where that leads nowhere, from full braking and
//! full acceleration.

use crate::predict::steady;
use crate::trajectory::{DescentError, Optimiser, Optimum, Problem, Robust};
use crate::{Input, Scene, Trajectory};

/// A plan with the problem that it solves.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub problem: Problem,
    pub optimum: Optimum,
    /// Why it is not the problem that was posed.
    pub event: Option<String>,
}

/// The cheapest optimum from the last plan, one step later, and in trouble or every `look_around_every` steps (0: never)
/// from the extremes too.
///
/// # Errors
/// [`DescentError`] if none of the guesses leads to an optimum.
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

/// Inputs that brake or accelerate as hard as the vehicle can, straight on.
pub(crate) fn extremes(scene: &Scene) -> [Vec<Input>; 2] {
    let limits = &scene.ego.limits;
    [limits.acceleration_min_mps2, limits.acceleration_max_mps2]
        .map(|acceleration| steady(&scene.ego.state, acceleration, limits, scene.horizon, scene.step_s))
}

/// The last plan one step later, full braking and full acceleration.
fn guesses(scene: &Scene, last: Option<&Trajectory>) -> [Vec<Vec<Input>>; 3] {
    let keep = last.map_or_else(Vec::new, Trajectory::later_inputs);
    let [brake, accelerate] = extremes(scene);
    [vec![keep], vec![brake], vec![accelerate]]
}
