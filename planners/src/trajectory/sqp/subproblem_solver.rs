//! Directions: the QP subproblem at an iterate, solved.

use super::optimum::{DescentError, Optimum};
use super::qp_subproblem::QpSubproblem;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::{StageError, StageSolution, StageSolver};

/// Share of a curvature that is not convex which is tried before none.
const SOFTENED_CURVATURE: f64 = 0.3;

/// A stage solver with the QP subproblem that it works on and the step it has found.
#[derive(Clone, Debug, Default)]
pub(super) struct SubproblemSolver<S> {
    pub solver: S,
    pub problem: QpSubproblem,
    /// The step, with the multipliers of the QP subproblem.
    pub step: StageSolution,
}

impl<S: StageSolver> SubproblemSolver<S> {
    /// Solves the QP subproblem at `now`: with the exact Hessian if there are multipliers to make it from (`warm`) and it is
    /// convex; else with a third of its curvature; else by Gauss and Newton.
    pub fn solve_for_direction(
        &mut self,
        problem: &Problem,
        now: &mut Optimum,
        warm: bool,
        damping: f64,
    ) -> Result<(), DescentError> {
        self.problem.qp.damping = damping;
        let mut outcome = Err(StageError::NotConvex { stage: 0 });
        if warm && self.solver.accepts_curvature() {
            self.problem.use_lagrangian(problem, &now.iterate, &mut self.step);
            outcome = self.solve(now, damping == 0.0);
            now.statistics.fallbacks += usize::from(outcome.is_err());
            if matches!(outcome, Err(StageError::NotConvex { .. })) {
                self.problem.scale_curvature(SOFTENED_CURVATURE);
                // Problems of pairs often are not convex for many steps, and multipliers say as much of this problem as of the refused one.
                outcome = self.solve(now, damping == 0.0 && self.problem.qp.has_pairs());
            }
        }
        if outcome.is_err() {
            self.problem.use_gauss_newton();
            outcome = self.solve(now, false);
        }
        outcome.map_err(|source| DescentError::Step { step: now.statistics.programmes, source })
    }

    /// Solves the QP subproblem as it is; the work is counted in `now`.
    pub fn solve(&mut self, now: &mut Optimum, warm: bool) -> Result<(), StageError> {
        now.statistics.programmes += 1;
        let outcome = self.solver.solve(&self.problem.qp, &mut self.step, warm);
        now.statistics.inner_iterations += self.step.iterations;
        outcome
    }

    /// Expands the problem at an iterate and returns how far the step's multipliers are from optimal there; the step is zero
    /// afterwards.
    pub fn residual_at(&mut self, problem: &Problem, iterate: &Iterate) -> f64 {
        self.problem.linearize(problem, iterate);
        self.step.rest();
        self.residual()
    }

    /// The KKT residual of step and multipliers in the QP subproblem.
    pub fn residual(&mut self) -> f64 {
        self.problem.residual(&self.step)
    }
}
