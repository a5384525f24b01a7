//! How far a vehicle leaves its road.

use std::sync::Arc;

use interplay_planners::{Body, Route, State};

use super::peak::Peak;

/// Shorter distances beyond an edge are treated as zero: rounding, and the tolerance of planners that drive along the edge \[m\].
const ROUNDING_M: f64 = 1e-6;

/// The largest distance of a corner of the footprint beyond the edge of the route's strip that is beside the corner \[m\].
#[derive(Clone, Debug)]
pub struct OffRoad {
    route: Arc<Route>,
    body: Body,
    /// The distance, 0 if the footprint never left the strip \[m\].
    pub peak: Peak,
}

impl OffRoad {
    /// A vehicle that has not been seen yet.
    pub fn new(route: &Arc<Route>, body: Body) -> Self {
        OffRoad { route: Arc::clone(route), body, peak: Peak::default() }
    }

    /// Looks at one time, at which the mass centre is at the arc length `along_m` of the route.
    pub fn observe(&mut self, state: &State, along_m: f64, time_s: f64) {
        let (sin, cos) = libm::sincos(state.heading_rad);
        for [ahead, left] in self.body.local_corners() {
            let corner = [state.x_m + ahead * cos - left * sin, state.y_m + ahead * sin + left * cos];
            let at = self.route.locate(corner, Some(along_m + ahead));
            let [right_m, left_m] = [self.route.right.value(at.along_m), self.route.left.value(at.along_m)];
            let beyond_m = (right_m - at.across_m).max(at.across_m - left_m);
            if beyond_m > ROUNDING_M {
                self.peak.observe(beyond_m, time_s);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    fn beyond(scenario: &str, along_m: f64, across_m: f64, turn_rad: f64) -> Peak {
        let scenario = load(scenario, &[]).expect("authored");
        let vehicle = &scenario.vehicles[0];
        let [x_m, y_m] = vehicle.route.position(along_m, across_m);
        let heading_rad = vehicle.route.heading_at([x_m, y_m]) + turn_rad;
        let mut off_road = OffRoad::new(&vehicle.route, vehicle.body);
        off_road.observe(&State { x_m, y_m, heading_rad, speed_mps: 0.0 }, along_m, 0.7);
        off_road.peak
    }

    /// Across a straight road of 0.74 m, the footprint is 0.19 m wide and reaches 0.21 m ahead.
    #[test]
    fn distances_beyond_a_straight_edge_are_exact() {
        let at = |across_m: f64, turn_rad: f64| beyond("lane-change/front-nice", 3.0, across_m, turn_rad);
        assert_eq!((at(0.095, 0.0), at(0.4, 0.3)), (Peak::default(), Peak::default()));
        assert_eq!(at(0.095 - 1e-9, 0.0), Peak::default(), "a rounding error is not off the road");
        for (across_m, turn_rad, wanted_m) in [(0.05, 0.0, 0.045), (0.70, 0.0, 0.055), (0.74, 0.5, 0.0)] {
            let (sin, cos) = libm::sincos(turn_rad);
            let wanted_m = if turn_rad == 0.0 { wanted_m } else { 0.21 * sin + 0.095 * cos };
            let found = at(across_m, turn_rad);
            assert!((found.value - wanted_m).abs() < 1e-12, "{across_m}: {found:?}");
            assert_eq!(found.time_s, Some(0.7));
        }
    }

    /// Corners turn with the vehicle, on a road in any direction: with its centre on an edge a front or rear corner is beyond it.
    #[test]
    fn corners_are_those_of_the_body() {
        let scenario = load("intersection/nice", &[]).expect("authored");
        for vehicle in &scenario.vehicles {
            let (route, body) = (&vehicle.route, vehicle.body);
            let [right_m, left_m] = [route.right.value(0.5), route.left.value(0.5)];
            let front = [(left_m, 0.5), (right_m, -0.5)].map(|(across_m, turn_rad)| (across_m, turn_rad, body.front_m));
            let rear = [(left_m, -2.5), (right_m, 2.5)].map(|(across_m, turn_rad)| (across_m, turn_rad, body.rear_m));
            for (across_m, turn_rad, reach_m) in front.into_iter().chain(rear) {
                let [x_m, y_m] = route.position(0.5, across_m);
                let heading_rad = route.heading_at([x_m, y_m]) + turn_rad;
                let mut off_road = OffRoad::new(route, body);
                off_road.observe(&State { x_m, y_m, heading_rad, speed_mps: 0.0 }, 0.5, 1.0);
                let (sin, cos) = libm::sincos(turn_rad.abs());
                let wanted_m = reach_m * sin + 0.5 * body.width_m * cos.abs();
                let found_m = off_road.peak.value;
                assert!((found_m - wanted_m).abs() < 1e-9, "{}: {found_m} and {wanted_m}", vehicle.name);
            }
        }
    }

    /// Where lane 0 has ended, who stands in it is off the road, and who is before its end is not.
    #[test]
    fn the_end_of_a_ramp_is_an_edge() {
        assert_eq!(beyond("ramp-merge/front-tough", -20.0, 0.185, 0.0), Peak::default());
        let past = beyond("ramp-merge/front-tough", 20.0, 0.185, 0.0).value;
        assert!((past - (0.37 - 0.09)).abs() < 1e-6, "{past}");
    }
}
