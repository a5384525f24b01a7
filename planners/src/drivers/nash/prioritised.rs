//! A first guess of an equilibrium: the players plan one after the other, each around the plans of those before it.

use crate::Input;
use crate::trajectory::{Iterate, Optimiser, Problem, StageSolver, Term, Tolerances};

/// A guess need not be optimal: the tolerance of its descents.
const GUESS_TOLERANCE: f64 = 1e-3;
/// Most [work](crate::trajectory::Statistics::work) of one of them, before other homotopy classes are compared. One that takes more is
/// caught in an ellipse, and the joint start leads out of it sooner ([`Problem::start_outside`]).
const GUESS_WORK_LIMIT: usize = 100;

/// Per player, inputs that keep all apart where they can.
///
/// First each player plans as if alone. Of two whose plans lead into one another, the one that is ahead of the other there has priority;
/// the player with priority over most plans first. Where no two do, the plans alone are the guess. A player whose problem has no solution
/// keeps to its plan alone.
pub(super) fn prioritised<S: StageSolver>(optimiser: &mut Optimiser<S>, joint: &Problem) -> Vec<Vec<Input>> {
    let exact = optimiser.tolerances;
    optimiser.tolerances =
        Tolerances { residual: GUESS_TOLERANCE, decrease: GUESS_TOLERANCE, work_limit: GUESS_WORK_LIMIT, ..exact };
    let inputs = plans(optimiser, joint);
    optimiser.tolerances = exact;
    inputs
}

fn plans<S: StageSolver>(optimiser: &mut Optimiser<S>, joint: &Problem) -> Vec<Vec<Input>> {
    let players = joint.participants.len();
    let mut inputs: Vec<Vec<Input>> = vec![Vec::new(); players];
    for player in 0..players {
        inputs[player] = plan(optimiser, joint, &joint.start(&inputs), player, &[], Vec::new());
    }
    let alone = joint.start(&inputs);
    let mut order: Vec<usize> = (0..players).collect();
    let wins = wins(joint, &alone);
    if wins.iter().all(|count| *count == 0) {
        return inputs;
    }
    order.sort_by_key(|player| std::cmp::Reverse(wins[*player]));
    for (place, player) in order.iter().enumerate() {
        let guess = inputs[*player].clone();
        inputs[*player] = plan(optimiser, joint, &joint.start(&inputs), *player, &order[..place], guess);
    }
    inputs
}

/// The inputs of a player that knows the motions of `known` in `iterate` alone; the guess if no solution was found.
fn plan<S: StageSolver>(
    optimiser: &mut Optimiser<S>,
    joint: &Problem,
    iterate: &Iterate,
    player: usize,
    known: &[usize],
    guess: Vec<Input>,
) -> Vec<Input> {
    let concerns_known = |term: &&Term| match term {
        Term::Separation(pair) => known.contains(&pair.vehicle) || known.contains(&pair.from),
        _ => true,
    };
    let terms = joint.terms.iter().filter(concerns_known).cloned().collect();
    let seen = Problem { terms, participants: joint.participants.clone(), ..*joint };
    let alone = seen.alone(player, iterate);
    let guess = [guess];
    let solved = if known.is_empty() { optimiser.descend(&alone, &guess) } else { optimiser.optimise(&alone, &guess) };
    let [guess] = guess;
    solved.map_or(guess, |mut optimum| std::mem::take(&mut optimum.iterate.inputs[0]))
}

/// Over how many others each player has priority.
fn wins(joint: &Problem, alone: &Iterate) -> Vec<usize> {
    let mut wins = vec![0; joint.participants.len()];
    for term in &joint.terms {
        let Term::Separation(pair) = term else { continue };
        let (own, other) = (&alone.states[pair.vehicle], &alone.states[pair.from]);
        let meets = (1..=joint.horizon).find(|t| {
            let distance = pair.ellipses[t - 1].distance(own[*t].position(), other[*t].position());
            distance.squared < 1.0
        });
        let Some(t) = meets else { continue };
        let (sin, cos) = libm::sincos(other[t].heading_rad);
        let ([x, y], [other_x, other_y]) = (own[t].position(), other[t].position());
        let ahead_of_other_m = cos * (x - other_x) + sin * (y - other_y);
        let (sin, cos) = libm::sincos(own[t].heading_rad);
        let behind_m = cos * (other_x - x) + sin * (other_y - y);
        wins[if ahead_of_other_m >= behind_m { pair.vehicle } else { pair.from }] += 1;
    }
    wins
}
