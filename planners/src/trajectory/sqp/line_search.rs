//! The search along a step (see [`super::optimiser`] for the merit function).

use super::linearize::move_rows;
use super::optimiser::{FARTHER, Optimiser, Optimum};
use crate::Input;
use crate::trajectory::problem::{Cost, Iterate, Problem};
use crate::trajectory::stage::{StageSolution, StageSolver};

/// What a search remembers from one step to the next.
#[derive(Clone, Debug)]
pub(super) struct Search {
    /// `κ`: the share of the linear penalties that the merit counts.
    firmness: f64,
    pub(super) trial: Iterate,
    held: StageSolution,
}

impl Default for Search {
    fn default() -> Self {
        Search { firmness: LEAST_FIRMNESS, trial: Iterate::default(), held: StageSolution::default() }
    }
}

const LEAST_FIRMNESS: f64 = 1e-4;
/// Rounding of a cost of order 1.
const ROUNDING: f64 = 1e-13;

impl Search {
    /// Forgets the last descent (and keeps its memory).
    pub(super) fn restart(&mut self) {
        self.firmness = LEAST_FIRMNESS;
    }

    fn merit(&self, cost: &Cost) -> f64 {
        cost.total - (1.0 - self.firmness) * cost.steep
    }
}

impl<S: StageSolver> Optimiser<S> {
    /// Chooses `κ` for the step's multipliers and returns the decrease of the merit that the step promises.
    /// Its model promises a decrease of the whole cost, `promised`.
    pub(super) fn predict(&mut self, cost: &Cost, promised: f64) -> f64 {
        let (steep, share) = self.qp.steep(&self.step);
        let enough = (2.0 * share).clamp(LEAST_FIRMNESS, 1.0);
        self.search.firmness = enough.max(0.5 * self.search.firmness);
        promised - (1.0 - self.search.firmness) * (cost.steep - steep)
    }

    /// Moves along the step as far as pays; returns the share of it that was taken. The last step of a descent promises
    /// less than the merit's own rounding and is taken unless the cost rises by more than its own.
    pub(super) fn advance(&mut self, problem: &Problem, now: &mut Optimum, predicted: f64, last: bool) -> f64 {
        const SHORTEST: f64 = 1.0 / 1024.0;
        if self.take(problem, now, 1.0, predicted, last) || self.correct(problem, now, predicted) {
            return 1.0;
        }
        let mut shares =
            std::iter::successors(Some(0.5), |share| Some(0.5 * share)).take_while(|share| *share >= SHORTEST);
        shares.find(|share| self.take(problem, now, *share, predicted, false)).unwrap_or(0.0)
    }

    /// Takes a share of the step if the merit falls by a sufficient part of what was predicted.
    pub(super) fn take(
        &mut self,
        problem: &Problem,
        now: &mut Optimum,
        share: f64,
        predicted: f64,
        last: bool,
    ) -> bool {
        const SUFFICIENT: f64 = 1e-4;
        self.try_step(problem, &now.iterate, share);
        let cost = problem.cost(&self.search.trial);
        let (before, after) = (self.search.merit(&now.cost), self.search.merit(&cost));
        let pays = after < before && after <= before - SUFFICIENT * share * predicted.max(0.0);
        let accepted = pays || (last && cost.total <= now.cost.total + ROUNDING * (1.0 + now.cost.total.abs()));
        if accepted {
            std::mem::swap(&mut now.iterate, &mut self.search.trial);
            now.cost = cost;
        }
        accepted
    }

    /// Goes back to where the step just taken began.
    pub(super) fn undo(&mut self, now: &mut Optimum) {
        std::mem::swap(&mut now.iterate, &mut self.search.trial);
    }

    /// Second-order correction: the rows are taken where the full step really led, and the step problem is solved again.
    /// Without it, steps along a curved boundary are cut short for the little by which they miss it (Maratos).
    fn correct(&mut self, problem: &Problem, now: &mut Optimum, predicted: f64) -> bool {
        self.search.held.clone_from(&self.step);
        move_rows(problem, &self.search.trial, &self.step, &mut self.qp);
        self.qp.reach = Some(self.step.reach().times(FARTHER));
        let solved = self.solve_step(now, true).is_ok();
        let taken = solved && self.take(problem, now, 1.0, predicted, false);
        if !taken {
            self.step.clone_from(&self.search.held);
        }
        taken
    }

    pub(super) fn try_step(&mut self, problem: &Problem, from: &Iterate, share: f64) {
        let trial = &mut self.search.trial;
        trial.inputs.resize_with(from.inputs.len(), Vec::new);
        for (i, inputs) in from.inputs.iter().enumerate() {
            let steps = inputs.iter().zip(&self.step.inputs[i]);
            trial.inputs[i].clear();
            trial.inputs[i].extend(steps.map(|(input, [acceleration, steering])| Input {
                acceleration_mps2: input.acceleration_mps2 + share * acceleration,
                steering_rad: input.steering_rad + share * steering,
            }));
        }
        problem.roll_out(trial);
    }
}
