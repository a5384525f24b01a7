//! What a vehicle may do.

use crate::Trajectory;

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
