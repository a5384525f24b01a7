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
