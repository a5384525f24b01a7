//! Of a crowd, a recording tells of those near the ego alone: more would hide what there is to see, and fill the disk.

use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::{Frame, VehicleFrame};

use crate::nearest::nearest;

/// So many vehicles beside the ego have a label, and the ellipse that the ego keeps out of: more would cover the road.
const MOST_LABELLED: usize = 8;

/// Of a crowd those are told of who are within so many lengths of their bodies from the ego.
const NEAR_LENGTHS: f64 = 30.0;

/// Of each vehicle, whether the plans, numbers and words of a tick tell of it.
pub(super) fn told(scenario: &Scenario, frame: &Frame) -> Vec<bool> {
    let ego = frame.vehicles.get(scenario.ego_index());
    let is_told = |(vehicle, stated): (&VehicleFrame, &Vehicle)| {
        let Some(ego) = ego.filter(|ego| !ego.is_absent) else { return false };
        let reach_m = NEAR_LENGTHS * (stated.body.front_m + stated.body.rear_m);
        let (own, other) = (&ego.state, &vehicle.state);
        libm::hypot(other.x_m - own.x_m, other.y_m - own.y_m) <= reach_m
    };
    if !scenario.is_crowd() {
        return vec![true; frame.vehicles.len()];
    }
    frame.vehicles.iter().zip(&scenario.vehicles).map(is_told).collect()
}

/// Of each vehicle, whether it has a label: the ego and those nearest to it who are on the road and driven by somebody.
pub(super) fn labelled(scenario: &Scenario, frame: &Frame) -> Vec<bool> {
    let mut near = nearest(scenario, frame);
    near.truncate(MOST_LABELLED);
    (0..frame.vehicles.len()).map(|index| index == scenario.ego_index() || near.contains(&index)).collect()
}
