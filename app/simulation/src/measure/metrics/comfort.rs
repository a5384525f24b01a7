//! Comfort: means and peaks of a vehicle's accelerations and of its jerk.
//!
//! Longitudinal acceleration is the input; jerk is its change from one tick to the next, divided by the length of a tick; a vehicle
//! starts with zero acceleration. Lateral acceleration is the mean speed times the yaw rate of a tick.

use interplay_scenarios::MetricKind::{Flag, Number};
use interplay_scenarios::{Better, MetricComparison, MetricDeclaration};

use crate::measure::metric::{Metric, VehicleTick};
use crate::measure::vehicle_metric::{Fold, VehicleMetric, VehicleQuantity};

/// Braking is hard from this share of a vehicle's strongest braking on.
const HARD_BRAKING_SHARE: f64 = 0.75;

/// Urgencies above 1 by less than this are rounding.
const URGENCY_ROUNDING: f64 = 1e-9;

pub(super) const METRICS: &[&dyn Metric] = &[
    &MEAN_ACCELERATION,
    &MEAN_JERK,
    &PEAK_ACCELERATION,
    &PEAK_BRAKING,
    &PEAK_BRAKING_SHARE,
    &HARD_BRAKING,
    &PEAK_JERK,
    &PEAK_LATERAL_ACCELERATION,
    &PEAK_URGENCY,
    &PEAK_CALM_JERK,
    &PEAK_URGENT_JERK,
    &PEAK_CALM_LATERAL_ACCELERATION,
];

const MEAN_ACCELERATION: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle("mean_abs_acceleration", Number, "Mean magnitude of the acceleration [m/s²]"),
    Fold::Mean,
    VehicleQuantity::OverTick(|tick| Some(acceleration(tick).abs())),
);
const MEAN_JERK: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle("mean_abs_jerk", Number, "Mean magnitude of the jerk [m/s³]"),
    Fold::Mean,
    VehicleQuantity::OverTick(jerk),
);
const PEAK_ACCELERATION: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_acceleration_mps2",
        Number,
        "Largest magnitude of the longitudinal acceleration",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(|tick| Some(acceleration(tick).abs())),
);
const PEAK_BRAKING: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle("peak_braking_mps2", Number, "Largest deceleration")
        .better(Better::Lower)
        .with_others(),
    Fold::Peak,
    VehicleQuantity::OverTick(|tick| Some(-acceleration(tick))),
);
const PEAK_BRAKING_SHARE: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_braking_share",
        Number,
        "Largest deceleration as a share of the strongest braking that it is capable of",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(braking_share),
);
const HARD_BRAKING: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "hard_braking",
        Flag,
        "Whether it brakes hard: with at least 75 % of its strongest braking",
    )
    .compared(MetricComparison::Share)
    .better(Better::Lower)
    .with_others(),
    Fold::Count,
    VehicleQuantity::OverTick(|tick| braking_share(tick).map(|share| f64::from(share >= HARD_BRAKING_SHARE))),
);
const PEAK_JERK: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_jerk_mps3",
        Number,
        "Largest magnitude of the change of acceleration from tick to tick, over a tick",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(jerk),
);
const PEAK_LATERAL_ACCELERATION: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_lateral_acceleration_mps2",
        Number,
        "Largest magnitude of the lateral acceleration, speed times yaw rate",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(lateral_acceleration),
);

const PEAK_URGENCY: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_urgency",
        Number,
        "Largest factor by which the braking that a line, a leader or an imminent contact required exceeded comfortable braking; 1 if \
         comfortable braking sufficed",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(|tick| Some(tick.frame.urgency)),
);
const PEAK_CALM_JERK: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_calm_jerk_mps3",
        Number,
        "Largest magnitude of the jerk while its urgency is 1",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(|tick| if is_urgent(tick) { None } else { jerk(tick) }),
);
const PEAK_URGENT_JERK: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_urgent_jerk_mps3",
        Number,
        "Largest magnitude of the jerk while its urgency is above 1",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(|tick| if is_urgent(tick) { jerk(tick) } else { None }),
);
const PEAK_CALM_LATERAL_ACCELERATION: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle(
        "peak_calm_lateral_acceleration_mps2",
        Number,
        "Largest magnitude of the lateral acceleration while its urgency is 1",
    ),
    Fold::Peak,
    VehicleQuantity::OverTick(|tick| if is_urgent(tick) { None } else { lateral_acceleration(tick) }),
);

/// Whether braking is required that is harder than comfortable.
fn is_urgent(tick: &VehicleTick<'_>) -> bool {
    tick.frame.urgency > 1.0 + URGENCY_ROUNDING
}

fn acceleration(tick: &VehicleTick<'_>) -> f64 {
    tick.frame.input.acceleration_mps2
}

fn jerk(tick: &VehicleTick<'_>) -> Option<f64> {
    Some((acceleration(tick) - tick.previous_input.acceleration_mps2).abs() / tick.step_s)
}

/// Deceleration as a share of the strongest braking.
fn braking_share(tick: &VehicleTick<'_>) -> Option<f64> {
    Some(-acceleration(tick) / -tick.end.vehicle.limits.acceleration_min_mps2)
}

/// Magnitude of the lateral acceleration \[m/s²\].
fn lateral_acceleration(tick: &VehicleTick<'_>) -> Option<f64> {
    let [before, after] = [&tick.frame.state, tick.end.state];
    let yaw_rate_radps = (after.heading_rad - before.heading_rad) / tick.step_s;
    Some((0.5 * (before.speed_mps + after.speed_mps) * yaw_rate_radps).abs())
}

#[cfg(test)]
mod tests {
    use interplay_planners::{Input, State};

    use super::*;
    use crate::measure::metrics::tests::{over_ticks, peak};
    use crate::measure::values::{Measured, MetricValue};

    const STILL: [State; 2] = [State { x_m: 0.0, y_m: 0.0, heading_rad: 0.0, speed_mps: 0.0 }; 2];

    fn pulse(metric: VehicleMetric, accelerations_mps2: &[f64]) -> Measured {
        let input = |acceleration_mps2: &f64| Input { acceleration_mps2: *acceleration_mps2, steering_rad: 0.0 };
        over_ticks(&metric, &accelerations_mps2.iter().map(|one| (input(one), STILL)).collect::<Vec<_>>())
    }

    /// A run of one tick of 0.1 s each second.
    #[test]
    fn means_and_peaks_of_a_pulse_are_exact() {
        let of = |metric| pulse(metric, &[0.0, 1.0, -2.0, 0.0]);
        let number = |metric| of(metric).value.map_or(f64::NAN, MetricValue::as_number);
        assert!((number(MEAN_ACCELERATION) - 0.75).abs() < 1e-12);
        assert!((number(MEAN_JERK) - 15.0).abs() < 1e-12);
        assert_eq!([of(PEAK_ACCELERATION), of(PEAK_BRAKING)], [peak(2.0, Some(2.0)), peak(2.0, Some(2.0))]);
        assert!((number(PEAK_JERK) - 30.0).abs() < 1e-12 && of(PEAK_JERK).time_s == Some(2.0));
        assert_eq!(of(PEAK_LATERAL_ACCELERATION), peak(0.0, None));
        let faster = |metric| pulse(metric, &[1.5]);
        assert_eq!([faster(PEAK_ACCELERATION), faster(PEAK_BRAKING)], [peak(1.5, Some(0.0)), peak(0.0, None)]);
    }

    /// Hard braking is defined relative to the vehicle's strongest braking, limit included.
    #[test]
    fn hard_braking_is_a_share_of_the_strongest_possible_braking() {
        let scenario = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
        let strongest_mps2 = -scenario.vehicles[0].limits.acceleration_min_mps2;
        for (share, is_hard) in [(0.74, false), (0.75, true), (1.0, true)] {
            let measured = |metric| pulse(metric, &[0.0, -share * strongest_mps2, 0.3]);
            assert_eq!(measured(HARD_BRAKING).value, Some(MetricValue::Flag(is_hard)), "{share}");
            let found = measured(PEAK_BRAKING_SHARE).value.map_or(f64::NAN, MetricValue::as_number);
            assert!((found - share).abs() < 1e-12, "{found} {share}");
        }
    }

    /// On a circle, lateral acceleration is the speed squared over the radius, in both directions.
    #[test]
    fn lateral_acceleration_on_a_circle_is_speed_squared_over_radius() {
        let (speed_mps, radius_m, step_s) = (12.0, 40.0, 0.1);
        for sign in [1.0, -1.0] {
            let turn_rad = sign * speed_mps * step_s / radius_m;
            let states = [0.3, 0.3 + turn_rad].map(|heading_rad| State { heading_rad, speed_mps, ..State::default() });
            let found = over_ticks(&PEAK_LATERAL_ACCELERATION, &[(Input::default(), states)]);
            let value = found.value.map_or(f64::NAN, MetricValue::as_number);
            assert!((value - speed_mps * speed_mps / radius_m).abs() < 1e-9, "{found:?}");
            assert_eq!(found.time_s, Some(0.0));
        }
    }
}
