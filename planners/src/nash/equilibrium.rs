//! Generalised Nash equilibria, and the certificate that they are some.
//!
//! A player `i` decides its inputs `u_i` with the cost `J_i(u_i)` of its own motion, and shares with each other player the
//! constraint that both keep apart. At a generalised Nash equilibrium nobody can lower its own cost while the others keep to theirs:
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
//! A local optimum of the sum is an equilibrium against small deviations. Whether it is one against all, the certificate says: each
//! player's own problem is solved anew, from the equilibrium and in the other classes of motion. A player who gains leaves, and
//! the joint descent goes on from there; since the potential falls each time, this ends.

use super::prioritised::prioritised;
use crate::Input;
use crate::trajectory::{DescentError, Optimiser, Optimum, Problem, StageSolver};

/// Most that a player may gain by leaving an equilibrium.
pub const TOLERATED_GAIN: f64 = 1e-4;

/// Most times that a player who gains leaves in search of an equilibrium.
const MOST_DEPARTURES: usize = 6;

/// A solution of the game with its certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// The motions of all players.
    pub optimum: Optimum,
    /// What each player gains by its best deviation, as far as one was found.
    pub gains: Vec<f64>,
    /// How often a player who gained left before.
    pub departures: usize,
}

impl Equilibrium {
    /// The most that one player gains by leaving.
    pub fn largest_gain(&self) -> f64 {
        self.gains.iter().copied().fold(0.0, f64::max)
    }

    /// Whether no player gains more than [`TOLERATED_GAIN`].
    pub fn is_certified(&self) -> bool {
        self.largest_gain() <= TOLERATED_GAIN
    }
}

/// A deviation of one player.
struct Deviation {
    player: usize,
    gain: f64,
    inputs: Vec<Input>,
}

/// Finds an equilibrium of the players of a joint problem from a guess (per player, inputs); from an empty one, by letting the players
/// plan one after the other first.
///
/// `joint` solves the joint problem, and `replies` the problem of each player alone; where it compares the classes of motion, the
/// certificate holds against deviations into other classes too. The result need not be certified: see
/// [`Equilibrium::is_certified`].
///
/// # Errors
/// [`DescentError`] if the joint problem has no optimum.
pub fn equilibrium<S: StageSolver>(
    joint: &mut Optimiser<S>,
    replies: &mut Optimiser<S>,
    problem: &Problem,
    guess: &[Vec<Input>],
) -> Result<Equilibrium, DescentError> {
    let first = guess.is_empty().then(|| prioritised(replies, problem));
    let mut optimum = joint.optimise(problem, first.as_deref().unwrap_or(guess))?;
    let mut departures = 0;
    loop {
        let deviations = deviations(replies, problem, &optimum);
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
            return Ok(Equilibrium { optimum, gains, departures });
        };
        next.statistics.add(&optimum.statistics);
        optimum = next;
        departures += 1;
    }
}

/// The best deviation of each player that a solution of its own problem finds; of no gain where there is none.
fn deviations<S: StageSolver>(replies: &mut Optimiser<S>, problem: &Problem, optimum: &Optimum) -> Vec<Deviation> {
    let iterate = &optimum.iterate;
    let deviation = |player: usize| {
        let alone = problem.alone(player, iterate);
        let kept = vec![iterate.inputs[player].clone()];
        let cost = alone.cost_of(&kept);
        let reply = replies.optimise(&alone, &kept).ok();
        let inputs = reply.as_ref().map_or(&kept[0], |reply| &reply.iterate.inputs[0]).clone();
        Deviation { player, gain: reply.map_or(0.0, |reply| (cost - reply.cost.total).max(0.0)), inputs }
    };
    (0..problem.participants.len()).map(deviation).collect()
}
