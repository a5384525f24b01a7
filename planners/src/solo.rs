//! How a vehicle that decides alone finds its plan: from the last one, and where that leads nowhere, from full braking and
//! full acceleration.

use crate::conservative::{self, extremes};
use crate::mpc::{DescentError, Optimiser, Optimum, Problem, Robust};
use crate::{Agent, Input, Scene, Trajectory};

/// A plan with the problem that it solves.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub problem: Problem,
    pub optimum: Optimum,
    /// Why it is not the problem that was posed.
    pub event: Option<String>,
}

/// The cheapest optimum from the last plan, one step later, and in trouble or every `look_around_every` steps (0: never)
/// from the extremes too. If there is none, that of the conservative problem.
///
/// # Errors
/// That of the conservative problem.
pub(crate) fn solve(
    optimiser: &mut Optimiser<Robust>,
    scene: &Scene,
    problem: Problem,
    last: Option<&Trajectory>,
    look_around_every: usize,
) -> Result<Solved, DescentError> {
    let look_around = look_around_every > 0 && scene.tick.is_multiple_of(look_around_every);
    match optimiser.best_of(&problem, &guesses(scene, last), look_around) {
        Ok(optimum) => Ok(Solved { problem, optimum, event: None }),
        Err(error) => retreat(optimiser, scene, last, &error),
    }
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
    let problem = conservative::problem(scene, &others);
    let optimum = optimiser.best_of(&problem, &guesses(scene, last), false)?;
    Ok(Solved { problem, optimum, event: Some(format!("conservative plan: {because}")) })
}

/// The last plan one step later, full braking and full acceleration.
fn guesses(scene: &Scene, last: Option<&Trajectory>) -> [Vec<Vec<Input>>; 3] {
    let keep = last.map_or_else(Vec::new, Trajectory::later_inputs);
    let [brake, accelerate] = extremes(scene);
    [vec![keep], vec![brake], vec![accelerate]]
}
