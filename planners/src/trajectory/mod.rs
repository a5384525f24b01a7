//! One trajectory optimiser for every planner.
//!
//! A planner poses a [`Problem`]: deciding vehicles and a list of [`Term`]s ([`terms`], one a file). An [`Optimiser`] descends
//! to a local optimum of it (`sqp`) by a sequence of quadratic programmes in stage form ([`StageQp`], `stage`), each solved
//! by a [`StageSolver`]. [`kkt`] checks optimality independently.

pub(crate) mod activity;
mod alone;
mod cost;
mod derivatives;
mod iterate;
mod participant;
mod penalty;
mod problem;
mod route_start;
mod sqp;
mod stage;
mod stage_bounds;
pub mod terms;

pub use cost::{Cost, Violation};
pub use derivatives::{DerivativeError, LargestDerivatives, check_derivatives, exact_model};
pub use iterate::Iterate;
pub use participant::Participant;
pub use penalty::Penalty;
pub use problem::Problem;
pub use route_start::RouteStart;
pub use sqp::{DescentError, HomotopySearch, Optimiser, Optimum, QpSubproblem, Statistics, Tolerances, WarmStart};
pub use stage::{
    Costates, Hessian, Interval, Reach, Robust, Row, RowBlock, Sparse, StageError, StageQp, StageSolution, StageSolver,
    StageStatus, StateCost, Structured, TrajectoryRow, VehicleStages, kkt,
};
pub use stage_bounds::StageBounds;
pub use terms::Term;
