//! Actuators: commands take effect with a lag and a rate limit.
//!
//! An actuator with the value `u` and the command `w` obeys `τ u′ = w − u`, and changes by no more than `u′_max` per second. Over
//! a sub-step `h` with constant `w` the lag alone gives `u⁺ = w + (u − w) e^(−h/τ)`, whatever `τ ≥ 0`.

use interplay_planners::Input;
use interplay_scenarios::Dynamic;

/// The present values of a vehicle's actuators.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Actuators {
    /// Acceleration and steering angle.
    pub now: Input,
}

impl Actuators {
    /// Advances the actuators by a sub-step with the command `wanted`.
    pub fn follow(&mut self, wanted: &Input, plant: &Dynamic, step_s: f64) {
        let Input { acceleration_mps2, steering_rad } = &mut self.now;
        let (jerk, rate) = (plant.jerk_max_mps3, plant.steering_rate_max_radps);
        *acceleration_mps2 +=
            change(wanted.acceleration_mps2 - *acceleration_mps2, plant.acceleration_lag_s, jerk, step_s);
        *steering_rad += change(wanted.steering_rad - *steering_rad, plant.steering_lag_s, rate, step_s);
    }
}

/// The change of a value that misses its command by `missing`.
fn change(missing: f64, lag_s: f64, rate_max: f64, step_s: f64) -> f64 {
    let share = if lag_s > 0.0 { 1.0 - libm::exp(-step_s / lag_s) } else { 1.0 };
    let most = rate_max * step_s;
    (share * missing).clamp(-most, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUB_STEP_S: f64 = 1e-3;

    /// The steering angle after some steps with a constant command, from zero.
    fn steered(wanted_rad: f64, plant: &Dynamic, steps: u32) -> f64 {
        let (mut actuators, wanted) = (Actuators::default(), Input { steering_rad: wanted_rad, ..Input::default() });
        for _ in 0..steps {
            actuators.follow(&wanted, plant, SUB_STEP_S);
        }
        actuators.now.steering_rad
    }

    #[test]
    fn an_actuator_lag_is_exponential_and_zero_lag_has_no_delay() {
        let plant = Dynamic { steering_lag_s: 0.07, ..Dynamic::default() };
        let expected = 0.1 * (1.0 - libm::exp(-0.05 / 0.07));
        assert!((steered(0.1, &plant, 50) - expected).abs() < 1e-12);
        let prompt = Dynamic { steering_lag_s: 0.0, steering_rate_max_radps: 1e6, ..plant };
        assert_eq!(steered(0.1, &prompt, 1), 0.1);
    }

    #[test]
    fn a_rate_limited_actuator_follows_a_ramp() {
        let plant = Dynamic { steering_lag_s: 0.0, steering_rate_max_radps: 2.0, ..Dynamic::default() };
        assert!((steered(-0.5, &plant, 100) + 0.2).abs() < 1e-12);
        assert!((steered(-0.5, &plant, 400) + 0.5).abs() < 1e-12);
    }
}
