//! The stage solver that planners use: the structured one, and the general one where that gives up.

use super::qp::{Hessian, StageQp};
use super::solution::StageSolution;
use super::solver::{StageError, StageSolver};
use super::sparse::Sparse;
use super::structured::Structured;

/// Tries [`Structured`], then [`Sparse`] on convex problems that it could not solve.
#[derive(Clone, Debug, Default)]
pub struct Robust {
    structured: Structured,
    sparse: Sparse,
}

impl StageSolver for Robust {
    fn accepts_curvature(&self) -> bool {
        true
    }

    fn solve(&mut self, problem: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError> {
        match self.structured.solve(problem, solution, warm) {
            Err(StageError::Unsolved { .. }) if problem.hessian == Hessian::GaussNewton => {
                self.sparse.solve(problem, solution, false)
            }
            other => other,
        }
    }
}
