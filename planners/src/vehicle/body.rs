//! The rectangle that a vehicle covers, and its axles.
//!
//! Steering without an optimiser: along a road, at a lateral position.
//!
//! With the lateral error `e` and the heading error `θ`, small angles give `e′ = v θ`. The heading rate
//!
//! ```text
//! θ′ = 2/τ (θ_d − θ),   θ_d = −e/(2 τ v), at most θ_max
//! ```
//!
//! makes `e″ = −2/τ e′ − e/τ²`: critically damped, without overshoot. The bicycle turns at `θ′ = v sin β/L_r`, from which
//! follow the slip angle `β` and the steering angle `tan δ = L/L_r tan β`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::State;

/// Body and axles of a vehicle, measured from its mass centre. The default is Table 6.1 (a 1/10 scale car).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Body {
    /// Distance from the mass centre to the front bumper \[m\].
    #[schemars(range(min = 0.001, max = 100.0))]
    pub front_m: f64,
    /// Distance from the mass centre to the rear bumper \[m\].
    #[schemars(range(min = 0.001, max = 100.0))]
    pub rear_m: f64,
    /// Width of the body, `W` \[m\].
    #[schemars(range(min = 0.001, max = 100.0))]
    pub width_m: f64,
    /// Distance from the mass centre to the front axle, `L_f` \[m\].
    #[schemars(range(min = 0.001, max = 100.0))]
    pub front_axle_m: f64,
    /// Distance from the mass centre to the rear axle, `L_r` \[m\].
    #[schemars(range(min = 0.001, max = 100.0))]
    pub rear_axle_m: f64,
    /// Length of the vehicle as a multiple of a 1/10 scale car's, by its `class`. Constants of the planners that are lengths
    /// are multiplied by it, times and speeds by its square root.
    #[schemars(range(min = 0.01, max = 1000.0), extend("x-unit" = "dimensionless"))]
    pub scale: f64,
}

impl Default for Body {
    fn default() -> Self {
        Body { front_m: 0.21, rear_m: 0.19, width_m: 0.19, front_axle_m: 0.21, rear_axle_m: 0.19, scale: 1.0 }
    }
}

impl Body {
    /// The `scale` of a real car.
    pub const REAL_SCALE: f64 = 10.0;

    /// Distance between the axles, `L = L_f + L_r` \[m\].
    pub fn wheelbase_m(&self) -> f64 {
        self.front_axle_m + self.rear_axle_m
    }

    /// Ratio of times to those of a 1/10 scale car by Froude's law of similarity: `√λ` with the ratio `λ` of lengths, so that
    /// accelerations are the same. It is also the ratio of speeds.
    pub fn time_ratio(&self) -> f64 {
        self.scale.sqrt()
    }

    /// Ratio of its lengths to those of a real car; those of times and speeds are its root.
    pub fn real_ratio(&self) -> f64 {
        self.scale / Self::REAL_SCALE
    }

    /// The corners in the body's own frame (x forward, y left), in the order of eq. 6.7: front right, front left,
    /// rear right, rear left \[m\].
    pub fn local_corners(&self) -> [[f64; 2]; 4] {
        let half = self.width_m / 2.0;
        [[self.front_m, -half], [self.front_m, half], [-self.rear_m, -half], [-self.rear_m, half]]
    }

    /// The corners in the world, in the order of [`Body::local_corners`] \[m\].
    pub fn corners(&self, state: &State) -> [[f64; 2]; 4] {
        let (sin, cos) = libm::sincos(state.heading_rad);
        self.local_corners()
            .map(|[ahead, left]| [state.x_m + cos * ahead - sin * left, state.y_m + sin * ahead + cos * left])
    }
}

/// Time constant `τ` of a 1/10 scale car \[s\].
const TIME_CONSTANT_S: f64 = 0.45;
/// Largest angle to the road, `θ_max` \[rad\].
const MAX_ANGLE_TO_ROAD_RAD: f64 = 0.4;
/// Below this speed the angles are those at this speed, for a 1/10 scale car \[m/s\].
const MIN_STEERING_SPEED_MPS: f64 = 0.1;
/// Largest requested sine of the slip angle.
const MAX_SIN_SLIP: f64 = 0.9;

/// What the steering angle of a vehicle depends on besides its motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SteeringGeometry {
    /// From the mass centre to the rear axle \[m\].
    pub rear_axle_m: f64,
    /// Between the axles \[m\].
    pub wheelbase_m: f64,
    /// Largest angle \[rad\].
    pub steering_max_rad: f64,
    /// Ratio of times and speeds to those of a 1/10 scale car ([`Body::time_ratio`](super::Body::time_ratio)).
    pub time_ratio: f64,
}

impl SteeringGeometry {
    /// The steering angle that corrects a lateral error and a heading error at a speed, on a road of some curvature \[rad\].
    pub fn correct(&self, error_m: f64, heading_error_rad: f64, speed_mps: f64, curvature_1pm: f64) -> f64 {
        let speed = speed_mps.max(MIN_STEERING_SPEED_MPS * self.time_ratio);
        let time_constant_s = TIME_CONSTANT_S * self.time_ratio;
        let wanted = (-error_m / (2.0 * time_constant_s * speed)).clamp(-MAX_ANGLE_TO_ROAD_RAD, MAX_ANGLE_TO_ROAD_RAD);
        let rate = 2.0 / time_constant_s * (wanted - heading_error_rad) + speed * curvature_1pm;
        let sin_slip = (self.rear_axle_m * rate / speed).clamp(-MAX_SIN_SLIP, MAX_SIN_SLIP);
        let tan_slip = sin_slip / (1.0 - sin_slip * sin_slip).sqrt();
        libm::atan(self.wheelbase_m / self.rear_axle_m * tan_slip).clamp(-self.steering_max_rad, self.steering_max_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_a_body_rotate_with_its_heading() {
        let body = Body::default();
        let state = State { x_m: 1.0, y_m: 2.0, heading_rad: std::f64::consts::FRAC_PI_2, speed_mps: 0.0 };
        let [front_right, ..] = body.corners(&state);
        assert!((front_right[0] - (1.0 + 0.095)).abs() < 1e-12 && (front_right[1] - 2.21).abs() < 1e-12);
    }
}
