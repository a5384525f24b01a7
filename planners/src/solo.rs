//! How a vehicle that decides alone finds its plan: from the last one, and where that leads nowhere, from full braking and
//! full acceleration.

use crate::conservative::extremes;
use crate::mpc::{DescentError, Optimiser, Optimum, Problem, Robust};
use crate::{Scene, Trajectory};

/// The cheapest optimum from the last plan, one step later, and in trouble or every `look_around_every` steps (0: never)
/// from the extremes too.
///
/// # Errors
/// That of the first guess, if every guess fails.
pub(crate) fn optimise(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    problem: &Problem,
    last: Option<&Trajectory>,
    look_around_every: usize,
) -> Result<Optimum, DescentError> {
    let keep = last.map_or_else(Vec::new, Trajectory::later_inputs);
    let [brake, accelerate] = extremes(scene);
    let look_around = look_around_every > 0 && scene.tick.is_multiple_of(look_around_every);
    optimiser.best_of(problem, &[vec![keep], vec![brake], vec![accelerate]], look_around)
}
