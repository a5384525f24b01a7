//! Equilibria by best responses: each player in turn plans anew against the plans of the others, until no player gains by it.

use super::deviation::{Deviation, TOLERATED_GAIN};
use crate::Input;
use crate::trajectory::{Iterate, Optimiser, Optimum, Problem, StageSolver, Statistics};

/// Most rounds in which every player responds once.
const MOST_ROUNDS: usize = 40;

/// Best responses have settled where no player gains more than this in a round.
const SETTLED_GAIN: f64 = 0.1 * TOLERATED_GAIN;

/// What the best responses of one round were like.
#[derive(Default)]
struct Round {
    largest_gain: f64,
    statistics: Statistics,
}

/// The motions at which best responses settle, from a guess (per player, inputs), if they do and all of them were found.
///
/// The game has the potential `Σ_i J_i`, which falls with each response, so a round in which no player gains is reached or approached
/// (Monderer and Shapley, "Potential games", 1996). It is a generalised Nash equilibrium, but not the normalised one: which of the
/// players gives way more depends on the guess and on who responds first.
pub(super) fn best_responses<S: StageSolver>(
    responses: &mut Optimiser<S>,
    problem: &Problem,
    guess: &[Vec<Input>],
) -> Option<Optimum> {
    let mut iterate = problem.start(guess);
    let mut statistics = Statistics::default();
    for _ in 0..MOST_ROUNDS {
        let round = respond_in_turn(responses, problem, &mut iterate)?;
        statistics = Statistics { residual: 0.0, unfinished: 0, ..statistics };
        statistics.add(&round.statistics);
        if round.largest_gain <= SETTLED_GAIN {
            let cost = problem.cost(&iterate);
            return (statistics.unfinished == 0).then_some(Optimum { iterate, cost, statistics, runner_up_cost: None });
        }
    }
    None
}

/// Lets each player respond once; none if a response is not found.
fn respond_in_turn<S: StageSolver>(
    responses: &mut Optimiser<S>,
    problem: &Problem,
    iterate: &mut Iterate,
) -> Option<Round> {
    let mut round = Round::default();
    for player in 0..problem.participants.len() {
        let (deviation, statistics) = Deviation::find_best(responses, problem, iterate, player);
        round.statistics.add(&statistics?);
        round.largest_gain = round.largest_gain.max(deviation.gain);
        if deviation.gain > 0.0 {
            iterate.inputs[player] = deviation.inputs;
            problem.roll_out(iterate);
        }
    }
    Some(round)
}
