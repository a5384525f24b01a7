//! Of a crowd, a recording tells of those near the ego alone: more would hide what there is to see, and fill the disk.

use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::{Frame, VehicleFrame};

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
