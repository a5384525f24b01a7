//! One trajectory optimiser for every planner: costs, constraints and a sequential convex programme.
//!
//! A planner poses a [`Problem`]; an [`Optimiser`] descends to a local optimum of it by a sequence of quadratic
//! programmes in stage form ([`StageQp`]), each solved by a [`StageSolver`]. [`kkt`] checks optimality independently.

pub(crate) mod activity;
mod penalty;
mod problem;
mod sqp;
mod stage;
mod terms;

pub use penalty::Penalty;
pub use problem::{Cost, Iterate, KeepOut, Leaning, Participant, Problem, Separation, Tracking};
pub use sqp::{
    DescentError, Memory, Optimiser, Optimum, Statistics, Tolerances, add_curvature, drop_curvature, linearise,
};
pub use stage::{
    Interval, Reach, Robust, Row, RowBlock, Sparse, StageError, StageQp, StageSolution, StageSolver, StateCost,
    Structured, TrajectoryRow, VehicleStages, kkt,
};
pub use terms::{DistanceCost, DistancePrice, MeanSpeed};
