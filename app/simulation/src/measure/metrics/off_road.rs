//! The distance by which a vehicle leaves its road.

use interplay_planners::State;
use interplay_scenarios::MetricKind::{Flag, Number};
use interplay_scenarios::{MetricComparison, MetricDeclaration, Vehicle};

use crate::measure::metric::{Metric, VehicleMoment};
use crate::measure::vehicle_metric::{Fold, VehicleMetric, VehicleQuantity};

/// Distances beyond an edge below this are treated as zero: planners that follow the edge keep to it within micrometres, and no
/// road is marked to the millimetre \[m\].
const ROUNDING_M: f64 = 1e-3;
/// A vehicle is off the road if a corner is this far beyond an edge, in widths of its body: 5 cm for a car.
const OFF_ROAD_WIDTHS: f64 = 0.03;

const OFF_ROAD_DOC: &str = "Largest distance of a corner of the footprint beyond the edge of the road beside it; 0 if it never left \
                            the road";
const LEAVES_ROAD_DOC: &str =
    "Whether a corner was beyond an edge by more than 3 % of the width of its body: 5 cm of a car";

pub(super) const METRICS: &[&dyn Metric] = &[&OFF_ROAD, &LEAVES_ROAD];

const OFF_ROAD: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle("off_road_m", Number, OFF_ROAD_DOC),
    Fold::Peak,
    VehicleQuantity::AtMoment(off_road_m),
);

const LEAVES_ROAD: VehicleMetric = VehicleMetric::new(
    MetricDeclaration {
        comparison_key: Some("off_road"),
        ..MetricDeclaration::of_vehicle("leaves_road", Flag, LEAVES_ROAD_DOC).compared(MetricComparison::Share)
    },
    Fold::Count,
    VehicleQuantity::AtMoment(leaves_road),
);

/// The largest distance of a corner beyond the nearest edge of the route's strip; 0 if no corner is beyond one \[m\].
fn off_road_m(moment: &VehicleMoment<'_>) -> Option<f64> {
    Some(beyond_edge_m(moment.vehicle, moment.state, moment.along_m))
}

/// The largest distance of a corner of a vehicle, so far along its route, beyond the nearest edge of the route's strip; 0 if no corner is
/// beyond one \[m\].
pub fn beyond_edge_m(vehicle: &Vehicle, state: &State, along_m: f64) -> f64 {
    if vehicle.obstacle.is_some() {
        // A parked car at the kerb breaks no rule, so its distance is 0.
        return 0.0;
    }
    let (sin, cos) = libm::sincos(state.heading_rad);
    let beyond_m = vehicle.body.local_corners().map(|[ahead, left]| {
        let corner = [state.x_m + ahead * cos - left * sin, state.y_m + ahead * sin + left * cos];
        let at = vehicle.route.locate(corner, Some(along_m + ahead));
        let [right_m, left_m] = [vehicle.route.right.value(at.along_m), vehicle.route.left.value(at.along_m)];
        (right_m - at.across_m).max(at.across_m - left_m)
    });
    beyond_m.into_iter().filter(|beyond_m| *beyond_m > ROUNDING_M).fold(0.0, f64::max)
}

fn leaves_road(moment: &VehicleMoment<'_>) -> Option<f64> {
    off_road_m(moment).map(|off_road_m| f64::from(off_road_m > OFF_ROAD_WIDTHS * moment.vehicle.body.width_m))
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::measure::metrics::tests::{at_moments, peak};
    use crate::measure::values::{Measured, MetricValue};

    fn beyond_of(vehicle: &Vehicle, [along_m, across_m]: [f64; 2], turn_rad: f64) -> (Measured, f64) {
        let [x_m, y_m] = vehicle.route.position(along_m, across_m);
        let heading_rad = vehicle.route.heading_at([x_m, y_m]) + turn_rad;
        let state = State { x_m, y_m, heading_rad, speed_mps: 0.0 };
        let [measured, leaves] =
            [OFF_ROAD, LEAVES_ROAD].map(|metric| at_moments(&metric, vehicle, &[(0.7, state, along_m)]));
        let value = measured.value.expect("every vehicle has one").as_number();
        assert_eq!(leaves.value, Some(MetricValue::Flag(value > 0.03 * vehicle.body.width_m)));
        (measured, value)
    }

    fn beyond(scenario: &str, along_m: f64, across_m: f64, turn_rad: f64) -> (Measured, f64) {
        let scenario = load(scenario, &[]).expect("authored");
        beyond_of(&scenario.vehicles[0], [along_m, across_m], turn_rad)
    }

    /// On a straight road of 0.74 m; the footprint is 0.19 m wide and extends 0.21 m ahead.
    #[test]
    fn distances_beyond_a_straight_edge_are_exact() {
        let at = |across_m: f64, turn_rad: f64| beyond("lane-change/front-nice", 3.0, across_m, turn_rad);
        let on_the_road = (peak(0.0, None), 0.0);
        assert_eq!((at(0.095, 0.0), at(0.4, 0.3)), (on_the_road.clone(), on_the_road.clone()));
        for beyond_m in [1e-9, 2.6e-6, 0.9e-3] {
            assert_eq!(at(0.095 - beyond_m, 0.0), on_the_road, "{beyond_m} m: a millimetre is on the road");
        }
        for (across_m, turn_rad, wanted_m) in [(0.05, 0.0, 0.045), (0.70, 0.0, 0.055), (0.74, 0.5, 0.0)] {
            let (sin, cos) = libm::sincos(turn_rad);
            let wanted_m = if turn_rad == 0.0 { wanted_m } else { 0.21 * sin + 0.095 * cos };
            let (found, found_m) = at(across_m, turn_rad);
            assert!((found_m - wanted_m).abs() < 1e-12, "{across_m}: {found:?}");
            assert_eq!(found.time_s, Some(0.7));
        }
    }

    /// Corners rotate with the vehicle, on a road in any direction: with the centre on an edge, a front or rear corner is beyond it.
    #[test]
    fn corners_rotate_with_the_body() {
        let scenario = load("intersection/nice", &[]).expect("authored");
        for vehicle in &scenario.vehicles {
            let (route, body) = (&vehicle.route, vehicle.body);
            let [right_m, left_m] = [route.right.value(0.5), route.left.value(0.5)];
            let front = [(left_m, 0.5), (right_m, -0.5)].map(|(across_m, turn_rad)| (across_m, turn_rad, body.front_m));
            let rear = [(left_m, -2.5), (right_m, 2.5)].map(|(across_m, turn_rad)| (across_m, turn_rad, body.rear_m));
            for (across_m, turn_rad, reach_m) in front.into_iter().chain(rear) {
                let (sin, cos) = libm::sincos(f64::abs(turn_rad));
                let wanted_m = reach_m * sin + 0.5 * body.width_m * cos.abs();
                let (_, found_m) = beyond_of(vehicle, [0.5, across_m], turn_rad);
                assert!((found_m - wanted_m).abs() < 1e-9, "{}: {found_m} and {wanted_m}", vehicle.name);
            }
        }
    }

    /// A vehicle that stands beyond the end of lane 0 is off the road; one before its end is not.
    #[test]
    fn the_end_of_a_ramp_is_an_edge_of_the_road() {
        assert_eq!(beyond("ramp-merge/front-tough", -20.0, 0.185, 0.0).1, 0.0);
        let (_, past) = beyond("ramp-merge/front-tough", 20.0, 0.185, 0.0);
        assert!((past - (0.37 - 0.09)).abs() < 1e-6, "{past}");
    }
}
