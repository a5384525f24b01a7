//! Generalised Nash equilibria, and the certificate that they are some.
//!
//! A player `i` decides its inputs `u_i` with the cost `J_i(u_i)` of its own motion, and shares with each other player the
//! constraint that both keep apart. At a generalised Nash equilibrium no player can lower its own cost while the others keep to theirs:
//!
//! ```text
//! u_i* ∈ argmin { J_i(u_i)  :  u_i admissible,  g(u_i, u_{−i}*) ≥ 0 }     for every player i
//! ```
//!
//! The costs differ from player to player, but no cost depends on another's inputs, and each constraint holds for both. So the game
//! has a potential, `Σ_i J_i` (Facchinei, Piccialli and Sciandrone, "Decomposition algorithms for generalized potential games",
//! 2011): what a player saves alone, the sum saves. The optima of the joint problem under the shared constraints are equilibria, those in
//! which both players of a constraint have the same multiplier (Rosen's normalised equilibria). Other weights of the players, as
//! `1/Z_i` in the costs, give the other ones.
//!
//! The descent of the sum takes long for two reasons. Inside an ellipse it is caught: the linear rows of stages before the centre
//! point one way out and those behind it the other. So it begins outside (`Problem::start_outside`). Near a saddle, where two homotopy classes
//! part, the QP subproblem is not convex and the descent creeps. There it is cut short, and the players best-respond in turn from
//! where it has come to, each against the plans of the others, until no player gains (`best_responses.rs`).
//!
//! A local optimum of the sum is an equilibrium against small deviations. Whether it is one against all, the certificate says: each
//! player's own problem is solved anew, from the equilibrium and in the other homotopy classes. A player who gains leaves, and
//! the joint descent goes on from there; since the potential falls each time, this ends.

use super::best_responses::best_responses;
use super::deviation::{Deviation, TOLERATED_GAIN};
use super::prioritised::prioritised;
use crate::Input;
use crate::trajectory::{DescentError, Optimiser, Optimum, Problem, StageSolver};

/// Most times that a player who gains leaves in search of an equilibrium.
const MOST_DEPARTURES: usize = 6;

/// A candidate for a generalised Nash equilibrium with its certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// The motions of all players.
    pub optimum: Optimum,
    /// What each player gains by its best deviation, as far as one was found.
    pub gains: Vec<f64>,
    /// How many times a player that gained by deviating left before this solution was reached.
    pub departures: usize,
    /// Whether best responses settled here, since the descent of the joint problem did not end.
    pub by_best_responses: bool,
}

impl Equilibrium {
    /// The largest gain of a player that deviates alone.
    pub fn largest_gain(&self) -> f64 {
        self.gains.iter().copied().fold(0.0, f64::max)
    }

    /// Whether no player gains more than [`TOLERATED_GAIN`].
    pub fn is_certified(&self) -> bool {
        self.largest_gain() <= TOLERATED_GAIN
    }
}

/// Finds an equilibrium of the players of a joint problem from a guess (per player, inputs); from an empty one, by letting the players
/// plan one after the other first.
///
/// `joint` solves the joint problem, and `responses` the problem of each player alone; where it compares the homotopy classes, the
/// certificate holds against deviations into other classes too. The result need not be certified: see
/// [`Equilibrium::is_certified`].
///
/// # Errors
/// [`DescentError`] if the joint problem has no optimum.
pub fn equilibrium<S: StageSolver>(
    joint: &mut Optimiser<S>,
    responses: &mut Optimiser<S>,
    problem: &Problem,
    guess: &[Vec<Input>],
) -> Result<Equilibrium, DescentError> {
    let first = guess.is_empty().then(|| prioritised(responses, problem));
    let guess = first.as_deref().unwrap_or(guess);
    let (mut optimum, by_best_responses) = joint_optimum(joint, responses, problem, guess)?;
    let mut departures = 0;
    loop {
        let deviations = deviations(responses, problem, &optimum);
        let best = deviations.iter().max_by(|a, b| a.gain.total_cmp(&b.gain));
        let next = match best {
            Some(best) if best.gain > TOLERATED_GAIN && departures < MOST_DEPARTURES => {
                let mut inputs = optimum.iterate.inputs.clone();
                inputs[best.player].clone_from(&best.inputs);
                joint.descend(problem, &inputs).ok().filter(|next| next.cost.total < optimum.cost.total)
            }
            _ => None,
        };
        let Some(mut next) = next else {
            let gains = deviations.into_iter().map(|deviation| deviation.gain).collect();
            return Ok(Equilibrium { optimum, gains, departures, by_best_responses });
        };
        next.statistics.add(&optimum.statistics);
        optimum = next;
        departures += 1;
    }
}

/// The optimum of the joint problem; where its descent does not end, the motions at which best responses settle, from what it has come to
/// or from the guess, and whether they did.
fn joint_optimum<S: StageSolver>(
    joint: &mut Optimiser<S>,
    responses: &mut Optimiser<S>,
    problem: &Problem,
    guess: &[Vec<Input>],
) -> Result<(Optimum, bool), DescentError> {
    let outcome = joint.optimise(problem, &problem.start_outside(guess));
    let reached = match &outcome {
        Ok(optimum) if optimum.statistics.unfinished == 0 => return outcome.map(|optimum| (optimum, false)),
        Ok(optimum) => Some(optimum),
        Err(DescentError::NotConverged(reached)) => Some(reached.as_ref()),
        Err(_) => None,
    };
    let nearby = reached.and_then(|reached| best_responses(responses, problem, &reached.iterate.inputs));
    match nearby.or_else(|| best_responses(responses, problem, guess)) {
        Some(settled) => Ok((settled, true)),
        None => outcome.map(|optimum| (optimum, false)),
    }
}

/// The best deviation of each player that a solution of its own problem finds; of no gain where there is none.
fn deviations<S: StageSolver>(responses: &mut Optimiser<S>, problem: &Problem, optimum: &Optimum) -> Vec<Deviation> {
    let players = 0..problem.participants.len();
    players.map(|player| Deviation::find_best(responses, problem, &optimum.iterate, player).0).collect()
}
