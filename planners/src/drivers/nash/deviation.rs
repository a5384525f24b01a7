//! What a player gains by leaving the plans of all.

use crate::Input;
use crate::trajectory::{Iterate, Optimiser, Problem, StageSolver, Statistics};

/// Most that a player may gain by leaving an equilibrium.
pub const TOLERATED_GAIN: f64 = 1e-4;

/// A deviation of one player.
pub(super) struct Deviation {
    /// Index of the player.
    pub player: usize,
    /// What the player gains by it.
    pub gain: f64,
    /// Inputs of the player's deviating motion.
    pub inputs: Vec<Input>,
}

impl Deviation {
    /// The best one of a player that a solution of its own problem finds, and how that was found; the player's own motion where there
    /// is none.
    pub(super) fn find_best<S: StageSolver>(
        responses: &mut Optimiser<S>,
        problem: &Problem,
        iterate: &Iterate,
        player: usize,
    ) -> (Deviation, Option<Statistics>) {
        let alone = problem.alone(player, iterate);
        let kept = vec![iterate.inputs[player].clone()];
        let cost = alone.cost_of(&kept);
        let Ok(mut response) = responses.optimise(&alone, &kept) else {
            let inputs = iterate.inputs[player].clone();
            return (Deviation { player, gain: 0.0, inputs }, None);
        };
        let inputs = std::mem::take(&mut response.iterate.inputs[0]);
        (Deviation { player, gain: (cost - response.cost.total).max(0.0), inputs }, Some(response.statistics))
    }
}
