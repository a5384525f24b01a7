//! The amount by which a vehicle exceeds the speed limits of its lanes.

use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{MetricDeclaration, Vehicle};

use crate::measure::metric::{Metric, VehicleMoment};
use crate::measure::vehicle_metric::{Fold, VehicleMetric, VehicleQuantity};

const DOC: &str = "Largest speed above the limit of the lane that its route follows where it is; 0 if it kept to all limits, none \
                   if no lane on its way has one";

pub(super) const METRICS: &[&dyn Metric] = &[&SPEEDING];

const SPEEDING: VehicleMetric = VehicleMetric {
    applies: has_limits,
    ..VehicleMetric::new(
        MetricDeclaration::of_vehicle("speeding_mps", Number, DOC),
        Fold::Peak,
        VehicleQuantity::AtMoment(speeding_mps),
    )
};

/// Whether any lane of the route has a limit.
fn has_limits(vehicle: &Vehicle) -> bool {
    vehicle.route.legs.iter().any(|leg| leg.speed_limit_mps.is_some())
}

fn speeding_mps(moment: &VehicleMoment<'_>) -> Option<f64> {
    let limit_mps = moment.vehicle.route.leg(moment.along_m).and_then(|leg| leg.speed_limit_mps);
    limit_mps.map(|limit_mps| moment.state.speed_mps - limit_mps)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use interplay_planners::road::centre_line::Piece;
    use interplay_planners::road::network::{Lane, RoadNetwork};
    use interplay_planners::{CentreLine, Route, State};

    use super::*;
    use crate::measure::metrics::tests::{at_moments, peak};

    /// Three lanes of 100 m in a row, with limits of 20 m/s, none, and 10 m/s.
    fn route() -> Arc<Route> {
        let lane = |(index, limit_mps): (usize, Option<f64>)| {
            let start = [100.0 * index as f64, 0.0];
            let centre = CentreLine::from_pieces(start, 0.0, &[Piece::Straight { length_m: 100.0 }]).expect("a piece");
            let mut lane = Lane::new(&format!("lane-{index}"), centre, 3.5);
            lane.speed_limit_mps = limit_mps;
            lane.successors.extend((index < 2).then(|| format!("lane-{}", index + 1)));
            lane
        };
        let network = RoadNetwork::new([Some(20.0), None, Some(10.0)].into_iter().enumerate().map(lane).collect());
        let route = network.expect("a sound network").route(&["lane-0", "lane-1", "lane-2"]);
        Arc::new(route.expect("the lanes follow each other"))
    }

    fn moment(time_s: f64, along_m: f64, speed_mps: f64) -> (f64, State, f64) {
        (time_s, State { speed_mps, ..State::default() }, along_m)
    }

    #[test]
    fn speeding_has_no_value_on_a_route_without_limits() {
        let scenario = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
        let without = at_moments(&SPEEDING, &scenario.vehicles[0], &[moment(0.0, 1.0, 50.0)]);
        assert_eq!(without.value, None);
    }

    #[test]
    fn speeding_is_judged_by_the_limit_of_each_lane() {
        let scenario = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
        let vehicle = Vehicle { route: route(), ..scenario.vehicles[0].clone() };
        let mut seen = vec![(0.0, 10.0, 19.0), (1.0, 50.0, 20.0), (2.0, 150.0, 40.0)];
        let measured = |seen: &[(f64, f64, f64)]| {
            at_moments(
                &SPEEDING,
                &vehicle,
                &seen
                    .iter()
                    .map(|&(time_s, along_m, speed_mps)| moment(time_s, along_m, speed_mps))
                    .collect::<Vec<_>>(),
            )
        };
        for until in 1..=seen.len() {
            assert_eq!(measured(&seen[..until]), peak(0.0, None), "after {until} moments");
        }
        seen.extend([(3.0, 99.0, 21.0), (4.0, 210.0, 13.5), (5.0, 290.0, 12.0)]);
        assert_eq!(measured(&seen), peak(3.5, Some(4.0)));
    }
}
