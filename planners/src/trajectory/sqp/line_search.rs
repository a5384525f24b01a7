//! The backtracking search along a step (the parent module states the merit function).

use std::collections::VecDeque;

use super::optimum::Optimum;
use super::subproblem_solver::SubproblemSolver;
use crate::Input;
use crate::trajectory::cost::Cost;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::{StageSolution, StageSolver};

/// A step is expected to go no farther than this many times the one before.
pub(super) const REACH_GROWTH: f64 = 2.0;
/// Smallest share `κ` of the linear penalties in the merit.
const MIN_PENALTY_SHARE: f64 = 1e-4;
/// Share of the predicted decrease that a step must bring (Armijo).
const SUFFICIENT_DECREASE: f64 = 1e-4;
/// Smallest share of a step that is tried.
const MIN_STEP_SHARE: f64 = 1.0 / 1024.0;
/// Rounding of a cost of order 1.
const ROUNDING: f64 = 1e-13;

/// The merit function, and the memory of a search.
#[derive(Clone, Debug)]
pub(super) struct LineSearch {
    /// `κ`: the share of the linear penalties that the merit counts.
    penalty_share: f64,
    /// The iterate that was tried last.
    pub trial: Iterate,
    /// The step before its second-order correction.
    uncorrected: StageSolution,
    /// The costs of the last iterates but this one, the newest in front.
    earlier: VecDeque<Cost>,
}

impl Default for LineSearch {
    fn default() -> Self {
        LineSearch {
            penalty_share: MIN_PENALTY_SHARE,
            trial: Iterate::default(),
            uncorrected: StageSolution::default(),
            earlier: VecDeque::new(),
        }
    }
}

impl LineSearch {
    /// Forgets the last descent (and keeps its memory).
    pub fn restart(&mut self) {
        self.penalty_share = MIN_PENALTY_SHARE;
        self.forget_costs();
    }

    /// From now on steps must be better than the iterate at which they begin.
    pub fn forget_costs(&mut self) {
        self.earlier.clear();
    }

    /// Remembers the cost of an iterate that is left, up to the limit.
    pub fn remember(&mut self, cost: Cost, most: usize) {
        self.earlier.push_front(cost);
        self.earlier.truncate(most);
    }

    /// Chooses `κ` for the step's multipliers and returns the decrease of the merit that the step promises, given the
    /// decrease of the whole cost that its model promises.
    pub fn predict<S: StageSolver>(&mut self, steps: &SubproblemSolver<S>, cost: &Cost, promised: f64) -> f64 {
        let (after, share) = steps.problem.qp.linear_penalties(&steps.step);
        let enough = (2.0 * share).clamp(MIN_PENALTY_SHARE, 1.0);
        self.penalty_share = enough.max(0.5 * self.penalty_share);
        promised - (1.0 - self.penalty_share) * (cost.linear_penalties - after)
    }

    /// Moves along the step as far as pays; returns the share of it that was taken. The last step of a descent promises
    /// less than the merit's own rounding and is taken unless the cost rises by more than its own.
    pub fn advance<S: StageSolver>(
        &mut self,
        steps: &mut SubproblemSolver<S>,
        problem: &Problem,
        now: &mut Optimum,
        predicted: f64,
        last: bool,
    ) -> f64 {
        if self.take(&steps.step, problem, now, 1.0, predicted, last) || self.correct(steps, problem, now, predicted) {
            return 1.0;
        }
        let mut shares =
            std::iter::successors(Some(0.5), |share| Some(0.5 * share)).take_while(|share| *share >= MIN_STEP_SHARE);
        shares.find(|share| self.take(&steps.step, problem, now, *share, predicted, false)).unwrap_or(0.0)
    }

    /// Takes a share of the step if the merit falls by a sufficient part of what was predicted.
    pub fn take(
        &mut self,
        step: &StageSolution,
        problem: &Problem,
        now: &mut Optimum,
        share: f64,
        predicted: f64,
        last: bool,
    ) -> bool {
        self.try_step(step, problem, &now.iterate, share);
        let cost = problem.cost(&self.trial);
        let (before, after) = (self.merit_to_beat(now, share), self.merit(&cost));
        let pays = after < before && after <= before - SUFFICIENT_DECREASE * share * predicted.max(0.0);
        let accepted = pays || (last && cost.total <= now.cost.total + ROUNDING * (1.0 + now.cost.total.abs()));
        if accepted {
            std::mem::swap(&mut now.iterate, &mut self.trial);
            now.cost = cost;
        }
        accepted
    }

    /// Goes back to the iterate from which the last accepted step began.
    pub fn undo(&mut self, now: &mut Optimum) {
        std::mem::swap(&mut now.iterate, &mut self.trial);
    }

    /// Rolls out the inputs a share of the step away from an iterate, into `trial`.
    fn try_step(&mut self, step: &StageSolution, problem: &Problem, from: &Iterate, share: f64) {
        let trial = &mut self.trial;
        trial.inputs.resize_with(from.inputs.len(), Vec::new);
        for (i, inputs) in from.inputs.iter().enumerate() {
            let steps = inputs.iter().zip(&step.inputs[i]);
            trial.inputs[i].clear();
            trial.inputs[i].extend(steps.map(|(input, [acceleration, steering])| Input {
                acceleration_mps2: input.acceleration_mps2 + share * acceleration,
                steering_rad: input.steering_rad + share * steering,
            }));
        }
        problem.roll_out(trial);
    }

    /// What a share of a step has to be better than: the worst of the remembered iterates for a full step, else where it begins.
    fn merit_to_beat(&self, now: &Optimum, share: f64) -> f64 {
        let merit = self.merit(&now.cost);
        if share < 1.0 { merit } else { self.earlier.iter().map(|cost| self.merit(cost)).fold(merit, f64::max) }
    }

    fn merit(&self, cost: &Cost) -> f64 {
        cost.total - (1.0 - self.penalty_share) * cost.linear_penalties
    }

    /// Second-order correction: the rows are taken where the full step really led, and the QP subproblem is solved again.
    /// Without it, steps along a curved boundary are cut short for the little by which they miss it (Maratos).
    fn correct<S: StageSolver>(
        &mut self,
        steps: &mut SubproblemSolver<S>,
        problem: &Problem,
        now: &mut Optimum,
        predicted: f64,
    ) -> bool {
        self.uncorrected.clone_from(&steps.step);
        steps.problem.move_rows(problem, &self.trial, &steps.step);
        steps.problem.qp.reach = Some(steps.step.reach().times(REACH_GROWTH));
        let solved = steps.solve(now, true).is_ok();
        let taken = solved && self.take(&steps.step, problem, now, 1.0, predicted, false);
        if !taken {
            steps.step.clone_from(&self.uncorrected);
        }
        taken
    }
}
