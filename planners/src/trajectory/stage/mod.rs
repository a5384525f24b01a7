//! The quadratic programme of one step of the sequential method, and its solvers.
//!
//! [`StageQp`] states the problem, [`StageSolution`] its answer, [`StageSolver`] the trait of solvers: [`Structured`] is the
//! one that planners use, [`Sparse`] its oracle and, in [`Robust`], its fallback. [`kkt`] checks optimality without them.

mod adjoint;
pub mod kkt;
mod model;
mod qp;
mod robust;
mod solution;
mod solver;
mod sparse;
mod structured;

pub use adjoint::Costates;
pub(super) use adjoint::fill_costates;
pub use qp::{Hessian, Interval, Reach, Row, RowBlock, StageQp, StateCost, TrajectoryRow, VehicleStages};
pub use robust::Robust;
pub(crate) use solution::ACTIVE_MULTIPLIER;
pub use solution::StageSolution;
pub use solver::{StageError, StageSolver, StageStatus};
pub use sparse::Sparse;
pub use structured::Structured;
