//! The weights of a vehicle on deviations from its goal and on changes of its inputs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Diagonals of `Q` (on the deviation from the goal) and of `R` (on the change of the inputs) in eq. 6.6.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Weights {
    /// Of the position along the vehicle's road: must be 0, since goals have no longitudinal position.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/m²"))]
    pub x: f64,
    /// Of the position across the vehicle's road, which is y where the road runs along x \[1/m²\].
    #[schemars(range(min = 0.0), extend("x-unit" = "1/m²"))]
    pub y: f64,
    /// Of the heading \[1/rad²\].
    #[schemars(range(min = 0.0), extend("x-unit" = "1/rad²"))]
    pub heading: f64,
    /// Of the speed \[s²/m²\].
    #[schemars(range(min = 0.0), extend("x-unit" = "s²/m²"))]
    pub speed: f64,
    /// Of the change of acceleration from one tick to the next \[s⁴/m²\].
    #[schemars(range(min = 0.0), extend("x-unit" = "s⁴/m²"))]
    pub acceleration_change: f64,
    /// Of the change of the steering angle from one tick to the next \[1/rad²\].
    #[schemars(range(min = 0.0), extend("x-unit" = "1/rad²"))]
    pub steering_change: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Weights { x: 0.0, y: 1.0, heading: 0.5, speed: 1.0, acceleration_change: 0.1, steering_change: 0.1 }
    }
}

impl Weights {
    /// Diagonal of `Q` on (position along the vehicle's road, across it, θ, v).
    pub fn tracking(&self) -> [f64; 4] {
        [self.x, self.y, self.heading, self.speed]
    }

    /// Diagonal of `R` on (Δa, Δδ).
    pub fn comfort(&self) -> [f64; 2] {
        [self.acceleration_change, self.steering_change]
    }
}
