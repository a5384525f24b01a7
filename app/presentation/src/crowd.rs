//! Selects the vehicles of a crowd that are drawn in detail: names, colours and plans of distant vehicles would hide the interaction.

use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::{Frame, VehicleFrame};

/// Indices of the vehicles on the road that have a driver, without the ego, sorted by distance from the ego.
pub fn nearest_vehicles(scenario: &Scenario, frame: &Frame) -> Vec<usize> {
    let ego = scenario.ego_index();
    let Some(own) = frame.vehicles.get(ego).map(|vehicle| vehicle.state) else { return Vec::new() };
    let away_m = |index: &usize| {
        let state = &frame.vehicles[*index].state;
        libm::hypot(state.x_m - own.x_m, state.y_m - own.y_m)
    };
    let is_driven = |index: &usize| {
        *index != ego && scenario.vehicles[*index].obstacle.is_none() && !frame.vehicles[*index].is_absent
    };
    let mut near: Vec<usize> = (0..frame.vehicles.len()).filter(is_driven).collect();
    near.sort_by(|one, other| away_m(one).total_cmp(&away_m(other)));
    near
}

/// Most vehicles with a label and a safety ellipse besides the ego: more would cover the road.
const MAX_LABELLED: usize = 8;

/// Vehicles of a crowd are described within this distance from the ego, in lengths of their bodies.
const NEAR_LENGTHS: f64 = 30.0;

/// For each vehicle, whether a recording contains its plans, numbers and words at a tick: always, except that in a
/// crowd only vehicles near the ego have them.
pub fn described(scenario: &Scenario, frame: &Frame) -> Vec<bool> {
    let ego = frame.vehicles.get(scenario.ego_index());
    let is_near = |(vehicle, stated): (&VehicleFrame, &Vehicle)| {
        let Some(ego) = ego.filter(|ego| !ego.is_absent) else { return false };
        let reach_m = NEAR_LENGTHS * (stated.body.front_m + stated.body.rear_m);
        let (own, other) = (&ego.state, &vehicle.state);
        libm::hypot(other.x_m - own.x_m, other.y_m - own.y_m) <= reach_m
    };
    if !scenario.is_crowd() {
        return vec![true; frame.vehicles.len()];
    }
    frame.vehicles.iter().zip(&scenario.vehicles).map(is_near).collect()
}

/// For each vehicle, whether it has a label: the ego and the vehicles nearest to it have one.
pub fn labelled(scenario: &Scenario, frame: &Frame) -> Vec<bool> {
    let mut near = nearest_vehicles(scenario, frame);
    near.truncate(MAX_LABELLED);
    (0..frame.vehicles.len()).map(|index| index == scenario.ego_index() || near.contains(&index)).collect()
}
