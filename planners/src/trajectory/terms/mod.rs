//! The costs and soft constraints of a trajectory problem, one a file: value, gradient and Hessian, each stated once.
//!
//! A term has one of four shapes, which are all that the sequential method knows:
//!
//! | shape | adds to the cost | terms |
//! |---|---|---|
//! | [`StateCostTerm`] | `φ_t(x_t)` | [`Tracking`], [`DistanceCost`] |
//! | [`Comfort`] | `‖u_t − u_{t−1}‖²_R` | itself |
//! | [`RowTerm`] | the penalty of `c_t(x_t) + s ≥ 0` at every stage | [`RoadEdge`], [`KeepOut`], [`Separation`] |
//! | [`TrajectoryTerm`] | the penalty of one row over all states of a vehicle | [`Persuasion`], [`MeanSpeed`] |
//!
//! To add a term: a file here, which implements a shape, and a variant of [`Term`].

mod comfort;
mod distance_cost;
mod keep_out;
mod mean_speed;
mod persuasion;
mod road_edge;
mod separation;
mod shape;
mod term;
mod tracking;

pub use comfort::Comfort;
pub use distance_cost::{DistanceCost, DistancePrice};
pub use keep_out::KeepOut;
pub use mean_speed::{MeanSpeed, MeanSpeedBound};
pub use persuasion::Persuasion;
pub use road_edge::RoadEdge;
pub use separation::Separation;
#[cfg(doc)]
use shape::StateCostTerm;
pub(super) use shape::{MAX_ROWS_PER_STAGE, RowTerm, Shape, Subject, TrajectoryTerm};
pub use term::Term;
pub use tracking::Tracking;
