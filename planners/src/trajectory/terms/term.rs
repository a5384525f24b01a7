//! The list of all terms.

use super::shape::Shape;
use super::{Comfort, DistanceCost, KeepOut, MeanSpeedBound, Persuasion, RoadEdge, Separation, Tracking};

/// A cost or soft constraint of a trajectory problem.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// Distance from a desired motion.
    Tracking(Tracking),
    /// Changes of the input.
    Comfort(Comfort),
    /// Corners that stay on the road.
    RoadEdge(RoadEdge),
    /// An ellipse around a predicted motion that a vehicle keeps out of.
    KeepOut(KeepOut),
    /// Two deciding vehicles that keep apart.
    Separation(Separation),
    /// A trajectory nearer to one reference than to another.
    Persuasion(Persuasion),
    /// A bound on a mean speed.
    MeanSpeed(MeanSpeedBound),
    /// A price of the distance from a predicted motion.
    DistanceCost(DistanceCost),
}

impl Term {
    /// The term by its shape.
    pub(in crate::trajectory) fn shape(&self) -> Shape<'_> {
        match self {
            Term::Tracking(term) => Shape::StateCost(term),
            Term::Comfort(term) => Shape::InputChange(term),
            Term::RoadEdge(term) => Shape::Rows(term),
            Term::KeepOut(term) => Shape::Rows(term),
            Term::Separation(term) => Shape::Rows(term),
            Term::Persuasion(term) => Shape::Trajectory(term),
            Term::MeanSpeed(term) => Shape::Trajectory(term),
            Term::DistanceCost(term) => Shape::StateCost(term),
        }
    }
}
