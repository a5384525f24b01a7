//! The trait of the solvers of stage problems, and how they fail.

use interplay_convex::{ProblemError, Status};
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
    /// The solver found neither a solution nor a proof that there is none.
    #[error("not solved after {iterations} iterations: {status}")]
    Unsolved {
        /// Why the solver stopped.
        status: StageStatus,
        /// Number of iterations that were taken.
        iterations: usize,
    },
}

/// Why a solver of stage problems stopped without a result.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StageStatus {
    /// The iteration limit was reached, or the iterate is not finite.
    #[error("residual {residual:.1e}, dual residual at {dual_share:.1e} of its start")]
    InsufficientProgress {
        /// The largest violation of a constraint.
        residual: f64,
        /// The dual residual, as a share of that at the start.
        dual_share: f64,
    },
    /// The factorisation of a convex problem broke down.
    #[error("the factorisation broke down at stage {stage}")]
    NumericalError {
        /// Stage at which it broke down.
        stage: usize,
    },
    /// The solution breaks a row that was left out because it was expected to be out of reach.
    #[error("the solution is farther than expected")]
    BeyondReach,
    /// The solver does not take this number of deciding vehicles.
    #[error("{count} deciding vehicles, at most 4 are supported")]
    TooManyVehicles {
        /// Number of deciding vehicles.
        count: usize,
    },
    /// The general solver stopped.
    #[error("{0}")]
    General(Status),
    /// The general solver refused the problem.
    #[error(transparent)]
    Refused(#[from] ProblemError),
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
