//! The weights of a vehicle on deviations from its goal and on changes of its inputs.

use interplay_common::random::SplitMix64;
use interplay_planners::{Limits, State};
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

/// A random change of every start, uniform over `±` the stated amounts and drawn from the seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StartJitter {
    /// Largest shift along the vehicle's own heading \[m\].
    #[schemars(range(min = 0.0))]
    pub position_m: f64,
    /// Largest change of the speed, which stays within the vehicle's limits \[m/s\].
    #[schemars(range(min = 0.0))]
    pub speed_mps: f64,
}

impl StartJitter {
    /// A start, changed at random. It takes two numbers of the sequence: position, then speed.
    pub(crate) fn changed(&self, start: State, limits: &Limits, random: &mut SplitMix64) -> State {
        let [shift_m, faster_mps] = [self.position_m, self.speed_mps].map(|most| most * random.uniform(-1.0, 1.0));
        let (sin, cos) = libm::sincos(start.heading_rad);
        let speed_mps = if self.speed_mps > 0.0 {
            (start.speed_mps + faster_mps).max(limits.speed_min_mps).min(limits.speed_max_mps)
        } else {
            start.speed_mps
        };
        State { x_m: start.x_m + cos * shift_m, y_m: start.y_m + sin * shift_m, speed_mps, ..start }
    }
}
