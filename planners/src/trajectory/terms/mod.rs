//! The costs and soft constraints of a trajectory problem, one a file: value, gradient and Hessian, each stated once.
//!
//! A term has one of four shapes (`shape.rs`), which are all that the sequential method knows:
//!
//! | shape | adds to the cost | terms |
//! |---|---|---|
//! | `StateCostTerm` | `φ_t(x_t)` | [`Tracking`], [`FrenetTracking`], [`DistanceCost`] |
//! | change of input | `‖u_t − u_{t−1}‖²_R` | [`Comfort`] |
//! | `RowTerm` | the penalty of `c_t(x_t) + s ≥ 0` at every stage | [`RoadEdge`], [`StopLine`], [`KeepOut`], [`Separation`] |
//! | `TrajectoryTerm` | the penalty of one row over all states of a vehicle | [`Persuasion`], [`MeanSpeed`] |
//!
//! To add a term: a file here, which implements a shape, and a variant of [`Term`] below. Another crate adds its own as a
//! [`ForeignTerm`], without a change here.

mod comfort;
mod distance_cost;
mod foreign;
mod frenet_tracking;
mod keep_out;
mod mean_speed;
mod persuasion;
mod road_edge;
mod separation;
mod shape;
mod stop_line;
mod tracking;

pub use comfort::Comfort;
pub use distance_cost::{DistanceCost, DistancePrice};
pub use foreign::{CostOfState, ForeignTerm, RowOnPose, RowOnTrajectory};
pub use frenet_tracking::{FrenetTarget, FrenetTracking};
pub use keep_out::KeepOut;
pub use mean_speed::{MeanSpeed, MeanSpeedBound, SpeedMeasure};
pub use persuasion::Persuasion;
pub use road_edge::RoadEdge;
pub use separation::Separation;
pub(super) use shape::{MAX_ROWS_PER_STAGE, RowTerm, Shape, Subject, TrajectoryTerm};
pub use stop_line::StopLine;
pub use tracking::Tracking;

/// A cost or soft constraint of a trajectory problem.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// Cost of the deviation from a desired motion.
    Tracking(Tracking),
    /// Cost of the deviation from a desired place and speed on a curved road.
    FrenetTracking(FrenetTracking),
    /// Cost of changes of the input.
    Comfort(Comfort),
    /// Constraint that the corners of the body stay on the road.
    RoadEdge(RoadEdge),
    /// Constraint that the front stays before a line.
    StopLine(StopLine),
    /// Constraint that a vehicle keeps out of an ellipse around a predicted motion.
    KeepOut(KeepOut),
    /// Constraint that two deciding vehicles keep apart.
    Separation(Separation),
    /// Constraint that a trajectory is nearer to one reference than to another.
    Persuasion(Persuasion),
    /// Constraint on a mean speed.
    MeanSpeed(MeanSpeedBound),
    /// Cost that depends on the distance from a predicted motion.
    DistanceCost(DistanceCost),
    /// A cost or constraint of another crate.
    Foreign(ForeignTerm),
}

impl Term {
    /// The term of one vehicle, in a problem in which it is number 0; none if the term is of another vehicle, or of two.
    pub(in crate::trajectory) fn of_vehicle(&self, vehicle: usize) -> Option<Term> {
        let mut own = self.clone();
        let number = match &mut own {
            Term::Tracking(term) => &mut term.vehicle,
            Term::FrenetTracking(term) => &mut term.vehicle,
            Term::Comfort(term) => &mut term.vehicle,
            Term::RoadEdge(term) => &mut term.vehicle,
            Term::StopLine(term) => &mut term.vehicle,
            Term::KeepOut(term) => &mut term.vehicle,
            Term::Persuasion(term) => &mut term.vehicle,
            Term::MeanSpeed(term) => &mut term.vehicle,
            Term::DistanceCost(term) => &mut term.vehicle,
            Term::Foreign(term) => term.vehicle_mut(),
            Term::Separation(_) => return None,
        };
        let is_own = std::mem::replace(number, 0) == vehicle;
        is_own.then_some(own)
    }

    /// The term by its shape.
    pub(in crate::trajectory) fn shape(&self) -> Shape<'_> {
        match self {
            Term::Tracking(term) => Shape::StateCost(term),
            Term::FrenetTracking(term) => Shape::StateCost(term),
            Term::Comfort(term) => Shape::InputChange(term),
            Term::RoadEdge(term) => Shape::Rows(term),
            Term::StopLine(term) => Shape::Rows(term),
            Term::KeepOut(term) => Shape::Rows(term),
            Term::Separation(term) => Shape::Rows(term),
            Term::Persuasion(term) => Shape::Trajectory(term),
            Term::MeanSpeed(term) => Shape::Trajectory(term),
            Term::DistanceCost(term) => Shape::StateCost(term),
            Term::Foreign(term) => term.shape(),
        }
    }
}
