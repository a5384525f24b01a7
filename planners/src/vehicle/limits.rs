//! Physical limits of a vehicle: bounds on its input and speed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Body;

/// Hard bounds on input and speed (eq. 6.9). The default is Table 6.2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Smallest acceleration (the strongest braking), negative \[m/s²\].
    #[schemars(extend("exclusiveMaximum" = 0.0))]
    pub acceleration_min_mps2: f64,
    /// Largest acceleration \[m/s²\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub acceleration_max_mps2: f64,
    /// Largest steering angle to either side \[rad\].
    #[schemars(range(max = 1.5), extend("exclusiveMinimum" = 0.0))]
    pub steering_max_rad: f64,
    /// Smallest speed \[m/s\].
    #[schemars(range(min = 0.0))]
    pub speed_min_mps: f64,
    /// Largest speed \[m/s\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub speed_max_mps: f64,
    /// Largest lateral acceleration that the tyres take, `|v θ′|`: at each speed it bounds the steering angle. Without it only
    /// `steering_max` bounds the steering \[m/s²\].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.1, max = 100.0), example = 7.0)]
    pub lateral_acceleration_max_mps2: Option<f64>,
    /// Largest change of the steering angle per second: what turns the wheels can do no more. Without it they turn at once
    /// \[rad/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 100.0), extend("exclusiveMinimum" = 0.0), example = 0.4)]
    pub steering_rate_max_radps: Option<f64>,
    /// The limits of comfort, kept while no vehicle is in danger. Without it the driver uses all that the vehicle can do.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(example = serde_json::json!({ "jerk_mps3": 3.0 }))]
    pub comfort: Option<ComfortLimits>,
}

impl Limits {
    /// The strongest acceleration with the same sign as `direction` \[m/s²\]: the strongest braking for a negative value.
    pub fn strongest_mps2(&self, direction: f64) -> f64 {
        if direction < 0.0 { -self.acceleration_min_mps2 } else { self.acceleration_max_mps2 }
    }

    /// Largest steering angle of a body at a speed \[rad\].
    ///
    /// The bicycle turns at `θ′ = v sin β/L_r` (eq. 6.3), so the lateral acceleration `v² sin β/L_r` bounds the slip angle `β`, and
    /// `tan δ = L/L_r tan β` the steering angle.
    pub fn steering_max_at_rad(&self, body: &Body, speed_mps: f64) -> f64 {
        self.lateral_acceleration_max_mps2
            .map_or(self.steering_max_rad, |most| self.steering_at_rad(body, speed_mps, most))
    }

    /// The steering angle nearest to the wanted one that can be reached from the last one within a time \[rad\].
    pub fn steering_towards_rad(&self, last_rad: f64, wanted_rad: f64, elapsed_s: f64) -> f64 {
        let most_rad = self.steering_rate_max_radps.map_or(f64::INFINITY, |most| most * elapsed_s);
        wanted_rad.clamp(last_rad - most_rad, last_rad + most_rad)
    }

    /// Largest change of the steering angle per second of a driver to whom it is that urgent: what is comfortable, and what turns the wheels;
    /// none where they turn at once \[rad/s\].
    pub(crate) fn steering_rate_radps(&self, urgency: f64) -> Option<f64> {
        let comfortable = self.comfort.map(|comfort| comfort.steering_rate_radps * urgency);
        comfortable.into_iter().chain(self.steering_rate_max_radps).min_by(f64::total_cmp)
    }

    /// Bounds on the speed some time after a speed. A vehicle that is out of bounds (a plant that is not the model may leave it so) is
    /// asked to come back no faster than it can \[m/s\].
    pub(crate) fn speeds_within_reach(&self, [slowest, fastest]: [f64; 2], speed_mps: f64, elapsed_s: f64) -> [f64; 2] {
        let reachable_low = speed_mps + self.acceleration_max_mps2 * elapsed_s;
        let reachable_high = speed_mps + self.acceleration_min_mps2 * elapsed_s;
        [slowest.min(reachable_low), fastest.max(reachable_high)]
    }

    /// Largest steering angle of a body at a speed, with a largest lateral acceleration \[rad\].
    pub(crate) fn steering_at_rad(&self, body: &Body, speed_mps: f64, lateral_mps2: f64) -> f64 {
        let sin_slip = lateral_mps2 * body.rear_axle_m / (speed_mps * speed_mps);
        if sin_slip.is_nan() || sin_slip >= 1.0 {
            return self.steering_max_rad;
        }
        let tan_slip = sin_slip / (1.0 - sin_slip * sin_slip).sqrt();
        libm::atan(body.wheelbase_m() / body.rear_axle_m * tan_slip).min(self.steering_max_rad)
    }
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            acceleration_min_mps2: -1.0,
            acceleration_max_mps2: 1.0,
            steering_max_rad: std::f64::consts::FRAC_PI_3,
            speed_min_mps: 0.0,
            speed_max_mps: 1.5,
            lateral_acceleration_max_mps2: None,
            steering_rate_max_radps: None,
            comfort: None,
        }
    }
}

/// Bounds that are kept while no vehicle is in danger; what is measured of people on roads is below them in 95 of 100 cases
/// (`docs/guide/people.md`). The default is that of a real car.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ComfortLimits {
    /// Strongest braking, positive \[m/s²\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub braking_mps2: f64,
    /// Largest change of the acceleration per second \[m/s³\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub jerk_mps3: f64,
    /// Largest lateral acceleration \[m/s²\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub lateral_acceleration_mps2: f64,
    /// Largest change of the steering angle per second; 0.7 rad/s are 40 °/s \[rad/s\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub steering_rate_radps: f64,
    /// Time gap to the vehicle ahead, on top of the gap at standstill \[s\].
    #[schemars(range(min = 0.0))]
    pub time_gap_s: f64,
}

/// A vehicle stands still with this share of comfortable braking.
const LEAST_BRAKING_SHARE: f64 = 0.1;

impl ComfortLimits {
    /// Strongest braking of a driver to whom it is that urgent, positive, at a speed that it will have \[m/s²\].
    ///
    /// Brakes are released before the vehicle stands: with the jerk `j` there is time for it from a speed of `b²/2j` on.
    pub(crate) fn braking_at_mps2(&self, urgency: f64, speed_mps: f64) -> f64 {
        let jerk_mps3 = self.jerk_mps3 * urgency * urgency;
        let released_mps2 = (2.0 * jerk_mps3 * speed_mps.max(0.0)).sqrt().max(LEAST_BRAKING_SHARE * self.braking_mps2);
        released_mps2.min(self.braking_mps2 * urgency)
    }
}

impl Default for ComfortLimits {
    fn default() -> Self {
        ComfortLimits {
            braking_mps2: 3.0,
            jerk_mps3: 3.0,
            lateral_acceleration_mps2: 2.5,
            steering_rate_radps: 0.7,
            time_gap_s: 1.15,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bicycle, Input, State};

    #[test]
    fn the_steering_rate_is_limited() {
        let limits = Limits { steering_rate_max_radps: Some(0.4), ..Limits::default() };
        let after = |limits: Limits, wanted_rad: f64| limits.steering_towards_rad(0.1, wanted_rad, 0.1);
        assert!((after(limits, 0.5) - 0.14).abs() < 1e-12 && (after(limits, -0.5) - 0.06).abs() < 1e-12);
        assert_eq!([after(limits, 0.12), after(Limits::default(), -0.5)], [0.12, -0.5]);
        let comfortable = Limits { comfort: Some(ComfortLimits::default()), ..limits };
        assert_eq!(comfortable.steering_rate_radps(1.0), Some(0.4), "the wheels turn more slowly than is comfortable");
        assert_eq!(Limits { steering_rate_max_radps: None, ..comfortable }.steering_rate_radps(2.0), Some(1.4));
        assert_eq!(Limits::default().steering_rate_radps(1.0), None);
    }

    /// At the largest steering angle of a speed, `|v θ′|` of the bicycle is the limit; where the limit says nothing, so does it.
    #[test]
    fn the_largest_steering_angle_gives_the_largest_lateral_acceleration() {
        let (body, step_s) = (Body::default(), 1e-3);
        let limits = Limits { lateral_acceleration_max_mps2: Some(2.0), ..Limits::default() };
        for speed_mps in [1.0, 1.5, 3.0, 30.0] {
            let state = State { speed_mps, ..State::default() };
            let input = Input { acceleration_mps2: 0.0, steering_rad: limits.steering_max_at_rad(&body, speed_mps) };
            let turned_rad = Bicycle::new(&body, step_s).step(&state, &input).heading_rad;
            assert!((speed_mps * turned_rad / step_s - 2.0).abs() < 1e-9, "{speed_mps} m/s");
        }
        assert_eq!(limits.steering_max_at_rad(&body, 0.0), limits.steering_max_rad);
        assert_eq!(limits.steering_max_at_rad(&body, 0.1), limits.steering_max_rad);
        assert_eq!(Limits::default().steering_max_at_rad(&body, 30.0), limits.steering_max_rad);
    }
}
