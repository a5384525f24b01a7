//! The part of a planned input that a vehicle applies.

use crate::{Body, Input, Limits, State};

/// The input nearest to `wanted` within the limits of the vehicle.
///
/// The steering also keeps the lateral acceleration within its bound. The acceleration also keeps the speed within its bounds during the
/// next `step_s` seconds, whatever a fallback requests. Where a plant has driven the speed so far out of its bounds that no admissible
/// acceleration leads back in one step, the limits of the acceleration win.
pub fn applied_input(wanted: &Input, state: &State, body: &Body, limits: &Limits, step_s: f64) -> Input {
    let steering_max_rad = limits.steering_max_at_rad(body, state.speed_mps);
    let low = limits.acceleration_min_mps2.max((limits.speed_min_mps - state.speed_mps) / step_s);
    let high = limits.acceleration_max_mps2.min((limits.speed_max_mps - state.speed_mps) / step_s);
    Input {
        acceleration_mps2: wanted.acceleration_mps2.max(low).min(high),
        steering_rad: wanted.steering_rad.clamp(-steering_max_rad, steering_max_rad),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STEP_S: f64 = 0.1;

    proptest! {
        /// From any speed within the bounds, whatever is wanted, inputs and the next speed are within the bounds.
        #[test]
        fn inputs_and_the_next_speed_stay_within_the_limits(
            speed in 0.0..1.0, acceleration_mps2 in -20.0..20.0, steering_rad in -3.0..3.0,
        ) {
            let limits = Limits::default();
            let speed_mps = limits.speed_min_mps + speed * (limits.speed_max_mps - limits.speed_min_mps);
            let state = State { speed_mps, ..State::default() };
            let applied = applied_input(&Input { acceleration_mps2, steering_rad }, &state, &Body::default(), &limits, STEP_S);
            let bounds = limits.acceleration_min_mps2..=limits.acceleration_max_mps2;
            prop_assert!(bounds.contains(&applied.acceleration_mps2));
            prop_assert!(applied.steering_rad.abs() <= limits.steering_max_rad);
            let next_mps = speed_mps + STEP_S * applied.acceleration_mps2;
            prop_assert!(next_mps > limits.speed_min_mps - 1e-12 && next_mps < limits.speed_max_mps + 1e-12);
        }

        /// What is admissible is applied as it is, bit for bit.
        #[test]
        fn an_admissible_input_is_not_changed(acceleration_mps2 in -0.9..0.4, steering_rad in -0.2..0.2) {
            let limits = Limits::default();
            let state = State { speed_mps: 0.5 * limits.speed_max_mps, ..State::default() };
            let wanted = Input { acceleration_mps2, steering_rad };
            prop_assert_eq!(applied_input(&wanted, &state, &Body::default(), &limits, STEP_S), wanted);
        }
    }

    #[test]
    fn far_outside_its_bounds_a_speed_is_led_back_as_fast_as_the_vehicle_can() {
        let limits = Limits::default();
        let at = |speed_mps| State { speed_mps, ..State::default() };
        let applied = |speed_mps| {
            applied_input(&Input::default(), &at(speed_mps), &Body::default(), &limits, STEP_S).acceleration_mps2
        };
        assert_eq!(applied(limits.speed_min_mps - 10.0), limits.acceleration_max_mps2);
        // Too fast by less than one step of braking: exactly back to the bound.
        let slightly = limits.speed_max_mps + 0.5 * STEP_S * limits.acceleration_min_mps2.abs();
        assert!((slightly + STEP_S * applied(slightly) - limits.speed_max_mps).abs() < 1e-12);
    }
}
