//! What vehicles may do.

use crate::Trajectory;
use crate::driver_estimate::DriverEstimate;

/// What another vehicle may do if one hypothesis about its driver is true.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// The number of the hypothesis; it stays the same while the vehicle is in sight.
    pub hypothesis: usize,
    /// How likely the hypothesis is among those whose plan is known.
    pub probability: f64,
    /// The motion from now on.
    pub prediction: Trajectory,
}

/// What the others may do, and how old the last sighting of them is. Empty for a driver who is told the plans.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outlook {
    /// What each of the others may do, in the order of the scene; empty for a planner whose plans do not branch.
    pub alternatives: Vec<Vec<Alternative>>,
    /// What is believed of the driver of each of them, in the same order.
    pub estimates: Vec<DriverEstimate>,
    /// The age of the oldest sighting, in steps.
    pub delay: usize,
}

impl Outlook {
    /// What is believed of one of the drivers; nothing where its plan is told.
    pub fn estimate(&self, name: &str) -> Option<&DriverEstimate> {
        self.estimates.iter().find(|estimate| estimate.vehicle == name)
    }
}
