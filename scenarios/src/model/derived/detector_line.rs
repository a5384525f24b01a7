//! The position of a detector.

use interplay_planners::Axes;

use crate::model::scenario::Scenario;
use crate::model::traffic::lane_reference::LaneReference;
use crate::roads::Branch;

/// A line across a lane, and the driving direction of the lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetectorLine {
    /// The middle of the lane \[m\].
    pub middle_m: [f64; 2],
    /// The direction of the lane \[rad\].
    pub heading_rad: f64,
    /// Half the width of the lane \[m\].
    pub half_width_m: f64,
}

impl DetectorLine {
    /// The share of the motion between two positions \[m\] at which it crosses the line in the direction of the lane;
    /// `None` if it does not.
    pub fn passed_at(&self, from: [f64; 2], to: [f64; 2]) -> Option<f64> {
        let axes = Axes::along(self.heading_rad);
        let [before, after] =
            [from, to].map(|[x_m, y_m]| axes.components([x_m - self.middle_m[0], y_m - self.middle_m[1]]));
        if !(before[0] < 0.0 && after[0] >= 0.0) {
            return None;
        }
        let share = before[0] / (before[0] - after[0]);
        let across_m = before[1] + share * (after[1] - before[1]);
        (across_m.abs() <= self.half_width_m).then_some(share)
    }
}

impl Scenario {
    /// A line across a lane at a distance along it \[m\]; `None` if the lane does not exist or is shorter.
    pub fn detector_line(&self, lane: &LaneReference, along_m: f64) -> Option<DetectorLine> {
        match (lane, &self.network) {
            (LaneReference::Name(name), Some(network)) => {
                let lane = network.lane(name)?;
                let at = lane.centre.at(along_m);
                let is_there = (0.0..=lane.centre.length_m()).contains(&along_m);
                is_there.then(|| DetectorLine {
                    middle_m: lane.centre.position(along_m, 0.0),
                    heading_rad: at.heading_rad,
                    half_width_m: lane.half_width_m(along_m),
                })
            }
            (LaneReference::Number(number), None) => {
                let lanes = self.road.parallel_lanes()?;
                let route = self.road.route(Branch::default())?;
                let across_m = self.road.lane_centre_m(Branch::default(), *number)?;
                (*number < lanes.count).then(|| DetectorLine {
                    middle_m: route.centre.position(along_m, across_m),
                    heading_rad: route.centre.at(along_m).heading_rad,
                    half_width_m: 0.5 * self.road.lane_width_m(),
                })
            }
            _ => None,
        }
    }
}
