//! The shortest time to collision of any two vehicles in a run.

use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{MetricComparison, MetricDeclaration};

use crate::measure::metric::{Metric, ObservedTick};
use crate::measure::values::Measured;
use crate::measure::vehicle_metric::LeastOfRun;
use crate::physics::{MovingFootprint, near_pairs, radius_m, time_to_collision_s};

/// Vehicles with a longer time to collision are not on a collision course \[s\].
const MAX_TIME_TO_COLLISION_S: f64 = 100.0;

const DOC: &str = "Shortest time until two footprints would touch if both vehicles kept their velocities; none if no two vehicles were \
                   on a collision course";

pub(super) const METRICS: &[&dyn Metric] = &[&TIME_TO_COLLISION];

const TIME_TO_COLLISION: LeastOfRun = LeastOfRun {
    declaration: MetricDeclaration {
        report_key: Some("shortest_time_to_collision"),
        ..MetricDeclaration::of_run("time_to_collision_s", Number, DOC).compared(MetricComparison::Quantiles)
    },
    quantity: shortest,
};

/// The shortest time of any two vehicles, at the beginning of the tick: the time until two footprints would touch if both vehicles kept
/// the velocity of the tick; 0 if they touch already. The velocity of a tick is the displacement of the mass centre over the tick's
/// length; headings stay constant. Only times below `below_s` are needed, which limits the search.
fn shortest(tick: &ObservedTick<'_>, below_s: f64) -> Option<Measured> {
    let vehicles = tick.frame.vehicles.iter().zip(tick.end.states).zip(tick.end.vehicles).enumerate();
    let moving =
        vehicles.filter(|(_, ((before, _), _))| !before.is_absent).map(|(index, ((before, after), vehicle))| {
            let state = &before.state;
            let velocity_mps = [after.x_m - state.x_m, after.y_m - state.y_m].map(|moved_m| moved_m / tick.step_s);
            (index, MovingFootprint { body: &vehicle.body, state, velocity_mps })
        });
    let moving: Vec<(usize, MovingFootprint<'_>)> = moving.collect();
    let (mut within_s, mut found) = (below_s.min(MAX_TIME_TO_COLLISION_S), None);
    let circles: Vec<_> = moving.iter().map(|(_, one)| Some((one.state.position(), radius_m(one.body)))).collect();
    for [one, other] in near_pairs(&circles, within_s * fastest_approach_mps(&moving)) {
        if within_s <= 0.0 {
            return found;
        }
        let ((index, one), (other_index, other)) = (&moving[one], &moving[other]);
        if let Some(s) = time_to_collision_s(one, other, within_s).filter(|s| *s < within_s) {
            let between = [index, other_index].map(|index| tick.frame.vehicles[*index].name.clone());
            (within_s, found) = (s, Some(Measured::between(s, between, tick.frame.time_s)));
        }
    }
    found
}

/// Upper bound of the closing speed of any two vehicles along an axis \[m/s\].
fn fastest_approach_mps(moving: &[(usize, MovingFootprint<'_>)]) -> f64 {
    let spread = |axis: usize| {
        let along = || moving.iter().map(|(_, one)| one.velocity_mps[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let most = spread(0).max(spread(1));
    if most.is_nan() { f64::INFINITY } else { most.max(0.0) }
}

#[cfg(test)]
mod tests {
    use crate::measure::metric::SharedStates;
    use interplay_planners::{Input, State};
    use interplay_scenarios::load;

    use super::*;
    use crate::measure::metric::ObservedMoment;
    use crate::measure::values::MetricValue;
    use crate::state::frame::{Frame, VehicleFrame};

    /// The ego is behind and beside the others, one tick each second; only the front car is in its way.
    #[test]
    fn the_shortest_time_is_reported_with_its_pair() {
        let scenario = load("lane-change/front-nice", &[]).expect("authored");
        let end = ObservedMoment { time_s: 0.0, vehicles: &[], states: &[], along_m: &[] };
        let mut measure = TIME_TO_COLLISION.begin(&scenario, &end, 0);
        let state = |x_m, y_m, speed_mps| State { x_m, y_m, heading_rad: 0.0, speed_mps };
        // Closing speed and distance of the bumpers of ego and front: 1 s, 0.5 s, 2 s, and separating.
        for (time_s, ahead_m, speed_mps) in [(0.0, 1.0, 1.0), (1.0, 1.0, 2.0), (2.0, 2.0, 1.0), (3.0, 0.1, -1.0)] {
            let states = [state(5.0, 0.2, 1.0 + speed_mps), state(ahead_m + 5.4, 0.2, 1.0), state(2.0, 0.55, 1.0)];
            let vehicles = scenario.vehicles.iter().zip(states);
            let vehicles = vehicles.map(|(vehicle, state)| VehicleFrame {
                name: vehicle.name.clone(),
                state,
                ..VehicleFrame::default()
            });
            let frame = Frame { time_s, vehicles: vehicles.collect(), ..Frame::default() };
            let after = states.map(|state| State { x_m: state.x_m + scenario.step_s * state.speed_mps, ..state });
            measure.observe(&ObservedTick {
                frame: &frame,
                step_s: scenario.step_s,
                shared: &SharedStates::default(),
                previous_inputs: &[Input::default(); 3],
                end: ObservedMoment { time_s, vehicles: &scenario.vehicles, states: &after, along_m: &[0.0; 3] },
            });
        }
        let Measured { value, time_s, between, .. } = measure.measured();
        let names = [0, 1].map(|index: usize| scenario.vehicles[index].name.clone());
        assert_eq!((between, time_s), (Some(names), Some(1.0)));
        assert!((value.map_or(f64::NAN, MetricValue::as_number) - 0.5).abs() < 1e-4, "{value:?}");
    }
}
