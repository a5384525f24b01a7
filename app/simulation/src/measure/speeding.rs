//! How far a vehicle exceeds the speed limits of its lanes.

use std::sync::Arc;

use interplay_planners::Route;

use super::peak::Peak;

/// The largest speed above the limit of the lane that the route follows where the vehicle is \[m/s\].
#[derive(Clone, Debug)]
pub struct Speeding {
    route: Arc<Route>,
    /// The excess, 0 if no limit was exceeded \[m/s\].
    pub peak: Peak,
}

impl Speeding {
    /// A vehicle that has not been seen yet.
    pub fn new(route: &Arc<Route>) -> Self {
        Speeding { route: Arc::clone(route), peak: Peak::default() }
    }

    /// Whether any lane of the route has a limit.
    pub fn has_limits(&self) -> bool {
        self.route.legs.iter().any(|leg| leg.speed_limit_mps.is_some())
    }

    /// Looks at one time, at which the mass centre is at the arc length `along_m` of the route.
    pub fn observe(&mut self, speed_mps: f64, along_m: f64, time_s: f64) {
        let limit_mps = self.route.leg(along_m).and_then(|leg| leg.speed_limit_mps);
        if let Some(limit_mps) = limit_mps {
            self.peak.observe(speed_mps - limit_mps, time_s);
        }
    }
}

#[cfg(test)]
mod tests {
    use interplay_planners::CentreLine;
    use interplay_planners::road::centre_line::Piece;
    use interplay_planners::road::network::{Lane, RoadNetwork};

    use super::*;

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

    #[test]
    fn a_road_need_not_have_limits() {
        let scenario = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
        assert!(!Speeding::new(&scenario.vehicles[0].route).has_limits());
    }

    #[test]
    fn each_lane_has_its_own_limit() {
        let mut speeding = Speeding::new(&route());
        assert!(speeding.has_limits());
        for (time_s, along_m, speed_mps) in [(0.0, 10.0, 19.0), (1.0, 50.0, 20.0), (2.0, 150.0, 40.0)] {
            speeding.observe(speed_mps, along_m, time_s);
            assert_eq!(speeding.peak, Peak::default(), "after {time_s} s");
        }
        for (time_s, along_m, speed_mps) in [(3.0, 99.0, 21.0), (4.0, 210.0, 13.5), (5.0, 290.0, 12.0)] {
            speeding.observe(speed_mps, along_m, time_s);
        }
        assert_eq!(speeding.peak, Peak { value: 3.5, time_s: Some(4.0) });
    }
}
