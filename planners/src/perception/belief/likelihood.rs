//! How likely an observed motion is under a predicted one.
//!
//! Between two sightings, `m` ticks of length `T` apart, the driver is assumed to apply the inputs of its model with independent
//! normal errors of acceleration (`σ_a`) and steering angle (`σ_δ`). With the wheelbase `L`, the differences of observed and
//! predicted speed and heading are then normal with
//!
//! ```text
//! σ_v² = (σ_a m T)² + s_v²,      σ_θ² = (σ_δ m T v/L)² + s_θ² + σ_0²
//! ```
//!
//! where `s` is the standard deviation of what is sensed, that of the earlier estimate included, and `σ_0` keeps standing
//! vehicles from deciding anything by rounding errors.

use crate::vehicle::State;

/// `σ_0` \[rad\].
const LEAST_HEADING_SD_RAD: f64 = 1e-3;

/// By how much more the inputs of a driver of no known model spread: so much that its motion is at a likelihood in which a
/// model is wrong by two or three of its standard deviations.
const UNKNOWN_SPREAD_RATIO: f64 = 4.0;

/// How far a driver strays from its model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spread {
    /// Standard deviation of the acceleration \[m/s²\].
    pub acceleration_mps2: f64,
    /// Standard deviation of the steering angle \[rad\].
    pub steering_rad: f64,
}

impl Spread {
    /// That of a driver of no known model.
    pub(super) fn of_unknown(self) -> Spread {
        Spread {
            acceleration_mps2: UNKNOWN_SPREAD_RATIO * self.acceleration_mps2,
            steering_rad: UNKNOWN_SPREAD_RATIO * self.steering_rad,
        }
    }
}

/// A motion that was observed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ObservedMotion {
    /// The state in which it ended.
    pub end: State,
    /// How long it took \[s\].
    pub duration_s: f64,
    /// The vehicle's wheelbase \[m\].
    pub wheelbase_m: f64,
    /// Standard deviation of the difference of the sensed speeds `s_v` \[m/s\].
    pub speed_sd_mps: f64,
    /// Standard deviation of the difference of the sensed headings `s_θ` \[rad\].
    pub heading_sd_rad: f64,
}

impl ObservedMotion {
    /// The logarithm of the density of the observed speed and heading where `predicted` was expected.
    pub(super) fn log_likelihood(&self, predicted: &State, spread: Spread) -> f64 {
        let speed_sd = libm::hypot(spread.acceleration_mps2 * self.duration_s, self.speed_sd_mps);
        let turned_rad = spread.steering_rad * self.duration_s * predicted.speed_mps.abs() / self.wheelbase_m;
        let heading_sd = libm::hypot(libm::hypot(turned_rad, self.heading_sd_rad), LEAST_HEADING_SD_RAD);
        log_density(self.end.speed_mps - predicted.speed_mps, speed_sd)
            + log_density(self.end.heading_rad - predicted.heading_rad, heading_sd)
    }
}

/// `ln N(error; 0, sd²)` without the constant `−½ ln 2π`.
fn log_density(error: f64, sd: f64) -> f64 {
    let ratio = error / sd;
    -0.5 * ratio * ratio - libm::log(sd)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPREAD: Spread = Spread { acceleration_mps2: 0.3, steering_rad: 0.05 };

    fn observed(speed_mps: f64, heading_rad: f64, noise: f64) -> ObservedMotion {
        let end = State { speed_mps, heading_rad, ..State::default() };
        ObservedMotion { end, duration_s: 0.1, wheelbase_m: 0.4, speed_sd_mps: noise, heading_sd_rad: noise }
    }

    #[test]
    fn an_error_of_one_standard_deviation_costs_half_a_nat() {
        let expected = State { speed_mps: 1.0, ..State::default() };
        let at = |speed: f64, heading: f64| observed(speed, heading, 0.0).log_likelihood(&expected, SPREAD);
        assert!((at(1.0, 0.0) - at(1.03, 0.0) - 0.5).abs() < 1e-9);
        assert!((at(1.0, 0.0) - at(1.0, 0.0125) - 0.5).abs() < 0.01, "v T σ_δ/L = 0.0125 rad");
    }

    #[test]
    fn noise_makes_the_same_error_say_less() {
        let expected = State { speed_mps: 1.0, ..State::default() };
        let cost = |noise| {
            let at = |speed| observed(speed, 0.0, noise).log_likelihood(&expected, SPREAD);
            at(1.0) - at(1.1)
        };
        assert!(cost(0.05) < 0.3 * cost(0.0));
    }

    #[test]
    fn only_an_error_of_more_than_two_standard_deviations_speaks_for_no_model() {
        let expected = State { speed_mps: 1.0, ..State::default() };
        let gain = |sigmas: f64| {
            let motion = observed(1.0 + sigmas * 0.03, 0.0, 0.0);
            motion.log_likelihood(&expected, SPREAD.of_unknown()) - motion.log_likelihood(&expected, SPREAD)
        };
        assert!(gain(2.0) < 0.0 && gain(3.0) > 0.0, "{} {}", gain(2.0), gain(3.0));
    }
}
