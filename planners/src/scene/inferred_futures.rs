//! The futures of other vehicles that a driver infers.

use crate::Trajectory;
use crate::scene::driver_estimate::DriverEstimate;

/// The motion of another vehicle if one hypothesis about its driver is true.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// Index of the hypothesis; it stays the same while the vehicle is in sight.
    pub hypothesis: usize,
    /// Probability of the hypothesis, among those whose plan is known.
    pub probability: f64,
    /// The vehicle's motion from the present step on.
    pub prediction: Trajectory,
}

/// What a driver has inferred of the others: their possible motions, the beliefs, and their age. Empty for a driver that knows the
/// others' plans.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InferredFutures {
    /// The possible motions of each other vehicle, in the order of the scene; empty for a planner whose plans do not
    /// branch.
    pub alternatives: Vec<Vec<Alternative>>,
    /// The belief about the driver of each other vehicle, in the same order.
    pub estimates: Vec<DriverEstimate>,
    /// The age of the oldest observation, in steps.
    pub delay: usize,
}

impl InferredFutures {
    /// The belief about the driver of a vehicle, by the vehicle's name; `None` where its plan is known.
    pub fn estimate(&self, name: &str) -> Option<&DriverEstimate> {
        self.estimates.iter().find(|estimate| estimate.vehicle == name)
    }
}
