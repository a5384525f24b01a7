//! One descent: steps until the tolerances are met.

use super::exploration::GivesUp;
use super::line_search::{LineSearch, REACH_GROWTH};
use super::optimum::{DescentError, Optimum, Statistics, Tolerances};
use super::subproblem_solver::SubproblemSolver;
use super::warm_start::WarmStart;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::{Reach, StageSolution, StageSolver};

/// Smallest damping that is tried, in units of the comfort weights.
const MIN_DAMPING: f64 = 1.0;
/// Largest damping that is tried.
const MAX_DAMPING: f64 = 1e6;
/// A step of which a smaller share was taken is followed by a damped one.
const MIN_UNDAMPED_SHARE: f64 = 0.1;
/// Tolerance of the very last QP subproblem where rows on the verge of being active need it: such a row has slack and
/// multiplier of about its root.
const POLISH_TOLERANCE: f64 = 1e-14;
/// A KKT residual above this is worth polishing.
const POLISHED_RESIDUAL: f64 = 1e-6;

/// A descent and the memory that it needs; nothing is allocated once it has its size.
#[derive(Clone, Debug, Default)]
pub(super) struct Descent<S> {
    pub steps: SubproblemSolver<S>,
    pub search: LineSearch,
    previous_step: StageSolution,
    /// How far the first step was expected to lead.
    reach: Option<Reach>,
}

impl<S: StageSolver> Descent<S> {
    /// The beginning of a descent, with its QP subproblem posed.
    pub fn begin(&mut self, problem: &Problem, iterate: Iterate) -> Result<Optimum, DescentError> {
        let cost = problem.cost(&iterate);
        if !cost.total.is_finite() {
            return Err(DescentError::NotFinite);
        }
        self.search.restart();
        self.steps.problem.linearize(problem, &iterate);
        Ok(Optimum {
            iterate,
            cost,
            statistics: Statistics { starts: 1, ..Statistics::default() },
            runner_up_cost: None,
        })
    }

    /// Begins with what an earlier descent has left, one stage later. Returns whether nothing is left to do.
    pub fn resume(&mut self, start: &WarmStart, now: &mut Optimum, tolerances: &Tolerances) -> bool {
        self.steps.step.clone_from(&start.multipliers);
        self.steps.step.shift_stages();
        self.reach = start.reach;
        self.steps.problem.qp.reach = self.reach;
        now.statistics.residual = self.steps.residual();
        now.statistics.residual <= tolerances.residual
    }

    /// What the descent that has just ended leaves to the next one.
    pub fn leave(&self, start: &mut WarmStart) {
        start.multipliers.clone_from(&self.steps.step);
        start.reach = self.reach;
    }

    /// Takes steps until the tolerances are met. With `warm` the step holds multipliers to begin with.
    ///
    /// # Errors
    /// [`DescentError`]; an exploration may end with [`DescentError::NotBelow`] or [`DescentError::Settled`].
    pub fn run(
        &mut self,
        problem: &Problem,
        mut now: Optimum,
        warm: bool,
        gives_up: Option<&GivesUp>,
        tolerances: &Tolerances,
    ) -> Result<Optimum, DescentError> {
        let mut damping = 0.0;
        for step in 0..tolerances.iteration_limit {
            if now.statistics.work() >= tolerances.work_limit {
                break;
            }
            let warm = step > 0 || warm;
            self.previous_step.clone_from(&self.steps.step);
            if let Some(gives_up) = gives_up {
                let coarse = gives_up.programme_tolerance(now.cost.total, tolerances.exploration_share);
                self.steps.problem.qp.tolerance = self.steps.problem.qp.tolerance.max(coarse);
            }
            self.steps.solve_for_direction(problem, &mut now, warm, damping)?;
            let promised = -self.steps.problem.qp.change(&self.steps.step);
            if let Some(gives_up) = gives_up {
                gives_up.check(problem, &now, step, (1.0 + damping) * promised)?;
            }
            let predicted = self.search.predict(&self.steps, &now.cost, promised);
            let little = predicted <= tolerances.decrease * (1.0 + now.cost.total.abs());
            // A damped step promises little because it is short, not because there is little to gain.
            let damped_by = self.steps.problem.qp.damping;
            let last = damped_by == 0.0 && little;
            let cost = now.cost;
            let share = self.search.advance(&mut self.steps, problem, &mut now, predicted, last);
            self.search.remember(cost, tolerances.remembered_costs);
            if warm {
                self.steps.step.shorten(&self.previous_step, share);
            }
            damping = match next_damping(share, damped_by, last) {
                Some(damping) => damping,
                // Nothing is left to gain but what the merit's own rounding hides.
                None if now.statistics.residual <= POLISHED_RESIDUAL => return Ok(now),
                None => break,
            };
            self.expect_reach(problem, &mut now, step, damping);
            if last && now.statistics.residual > POLISHED_RESIDUAL {
                self.polish(problem, &mut now);
            }
            if last || now.statistics.residual <= tolerances.residual {
                return Ok(now);
            }
        }
        Err(DescentError::NotConverged(Box::new(now)))
    }

    /// Poses the next QP subproblem, and says how far its solution is expected to be.
    fn expect_reach(&mut self, problem: &Problem, now: &mut Optimum, step: usize, damping: f64) {
        // A damped step says little about the next.
        let reach = (damping == 0.0).then(|| self.steps.step.reach().times(REACH_GROWTH));
        if step == 0 {
            self.reach = reach;
        }
        now.statistics.residual = self.steps.residual_at(problem, &now.iterate);
        self.steps.problem.qp.reach = reach;
    }

    /// One more step, from a QP subproblem solved to the last digits, if that brings the optimality conditions nearer.
    /// (Where large weights cost more digits than that it does not.)
    fn polish(&mut self, problem: &Problem, now: &mut Optimum) {
        let Optimum { cost, statistics: Statistics { residual, .. }, .. } = *now;
        self.previous_step.clone_from(&self.steps.step);
        self.steps.problem.qp.tolerance = POLISH_TOLERANCE;
        self.search.forget_costs();
        let solved = self.steps.solve_for_direction(problem, now, true, 0.0).is_ok();
        if solved && self.search.take(&self.steps.step, problem, now, 1.0, 0.0, true) {
            now.statistics.residual = self.steps.residual_at(problem, &now.iterate);
            if now.statistics.residual <= residual {
                return;
            }
            self.search.undo(now);
            now.cost = cost;
        }
        self.steps.step.clone_from(&self.previous_step);
        now.statistics.residual = residual;
    }
}

/// The damping after a step of which a share was taken; nothing where no damping helps.
fn next_damping(share: f64, damping: f64, last: bool) -> Option<f64> {
    match share {
        0.0 if last => Some(0.0),
        0.0 if damping > MAX_DAMPING => None,
        0.0 => Some((16.0 * damping).max(MIN_DAMPING)),
        short if short < MIN_UNDAMPED_SHARE => Some((4.0 * damping).max(MIN_DAMPING)),
        1.0 if damping > MIN_DAMPING => Some(0.25 * damping),
        1.0 => Some(0.0),
        _ => Some(damping),
    }
}
