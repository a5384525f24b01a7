//! One trajectory optimiser for every planner: costs, constraints and a sequential convex programme.
//!
//! A planner poses a [`Problem`]; an [`Optimiser`] descends to a local optimum of it by a sequence of quadratic
//! programmes in stage form ([`StageQp`]), each solved by a [`StageSolver`]. [`kkt`] checks optimality independently.

mod across;
mod adjoint;
mod distance_cost;
pub mod kkt;
mod linearise;
mod mean_speed;
mod memory;
mod model;
mod problem;
mod robust;
mod scp;
mod search;
mod sparse;
mod stage;
mod starts;
mod structured;

pub use distance_cost::{DistanceCost, DistancePrice};
pub use linearise::{add_curvature, drop_curvature, linearise};
pub use mean_speed::MeanSpeed;
pub use memory::Memory;
pub use problem::{Cost, Iterate, KeepOut, Leaning, Limits, Participant, Penalty, Problem, Separation, Tracking};
pub use robust::Robust;
pub use scp::{DescentError, Optimiser, Optimum, Statistics, Tolerances};
pub use sparse::Sparse;
pub use stage::{
    Interval, Reach, Row, RowBlock, StageError, StageQp, StageSolution, StageSolver, StateCost, TrajectoryRow,
    VehicleStages,
};
pub use structured::Structured;
