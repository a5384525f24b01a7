//! The trait of the solvers of stage problems, and how they fail.

use thiserror::Error;

use super::qp::StageQp;
use super::solution::StageSolution;

/// Why a stage problem has no solution to offer.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StageError {
    /// No point satisfies the boxes and hard rows.
    #[error("the boxes and hard rows contradict each other ({iterations} iterations)")]
    Infeasible {
        /// Number of iterations that were taken.
        iterations: usize,
    },
    /// The Hessian is not positive definite on the dynamics.
    #[error("the problem is not convex at stage {stage}")]
    NotConvex {
        /// Stage at which the factorisation failed.
        stage: usize,
    },
    /// The solver reached its iteration limit, or broke down numerically.
    #[error("not solved after {iterations} iterations: {status}")]
    Unsolved {
        /// The solver's status.
        status: String,
        /// Number of iterations that were taken.
        iterations: usize,
    },
}

/// A solver of stage problems. It may keep memory between calls, but the answer must not depend on it beyond the stated
/// tolerance.
pub trait StageSolver {
    /// Whether the solver accepts an indefinite Hessian (and refuses it with [`StageError::NotConvex`] where it
    /// matters). Others are given Gauss-Newton problems only.
    fn accepts_curvature(&self) -> bool;

    /// Solves `problem`, writing the optimum and its multipliers to `solution`. With `warm`, the multipliers that
    /// `solution` holds belong to a neighbouring problem of the same shape and may serve as a start.
    ///
    /// # Errors
    /// [`StageError`]; `solution` is then meaningless.
    fn solve(&mut self, problem: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError>;
}
