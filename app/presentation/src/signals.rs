//! What vehicles signal: brake lights and indicators.

use interplay_planners::Route;
use interplay_planners::road::network::RouteLeg;
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::VehicleFrame;

use crate::lane_change::lane_change;

/// A vehicle brakes visibly if its acceleration is below this \[m/s²\].
const BRAKING_MPS2: f64 = -0.1;
/// How much a way turns away from the lane before it, where there is a choice, to be indicated \[rad\].
const TURN_RAD: f64 = 0.6;
/// How far ahead a turn is indicated, in lane widths.
const TURN_AHEAD_LANES: f64 = 5.0;
/// How long before it crosses the line a vehicle indicates a change of lane \[s\], at 1/10 scale: 3 s of a real car.
const LANE_CHANGE_AHEAD_S: f64 = 1.0;

/// The side to which a vehicle is going to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The vehicle moves to the left.
    Left,
    /// The vehicle moves to the right.
    Right,
}

/// Whether an acceleration lights the brake lights.
pub fn is_braking(acceleration_mps2: f64) -> bool {
    acceleration_mps2 < BRAKING_MPS2
}

/// To which side a plan leads: into another lane, or on a network around a corner.
pub fn turn(scenario: &Scenario, vehicle: &Vehicle, seen: &VehicleFrame) -> Option<Turn> {
    let states = &seen.plan.trajectory.states;
    let ahead = (LANE_CHANGE_AHEAD_S * vehicle.body.time_ratio() / scenario.step_s).ceil() as usize;
    let to_another_lane = lane_change(scenario, vehicle, &states[..states.len().min(ahead + 1)]);
    let along_m = vehicle.route.along(seen.state.position());
    let leftward = to_another_lane.or_else(|| turned_rad(scenario, &vehicle.route, along_m))?;
    Some(if leftward > 0.0 { Turn::Left } else { Turn::Right })
}

/// How much the way of a vehicle turns at the next lane from which several lead on, if that is near \[rad\].
///
/// From a lane that is itself bent at its end, as on a ring, a lane that is bent as much leads straight on.
fn turned_rad(scenario: &Scenario, route: &Route, along_m: f64) -> Option<f64> {
    let network = scenario.network.as_ref()?;
    let ahead_m = TURN_AHEAD_LANES * scenario.road.lane_width_m();
    let pairs = route.legs.windows(2).filter(|legs| {
        let is_choice = network.lane(&legs[0].lane).is_some_and(|lane| lane.successors.len() > 1);
        is_choice && legs[0].to_m - ahead_m < along_m && along_m < legs[1].to_m
    });
    let direction = |at_m: f64| {
        let [from, to] = [at_m - 0.01 * ahead_m, at_m].map(|at_m| route.centre.position(at_m, 0.0));
        libm::atan2(to[1] - from[1], to[0] - from[0])
    };
    let turned = |legs: &[RouteLeg]| {
        let (here_m, length_m) = (legs[0].to_m, legs[1].to_m - legs[1].from_m);
        let own_m = length_m.min(legs[0].to_m - legs[0].from_m).max(1e-3 * ahead_m);
        let own_rad = wrapped(direction(here_m) - direction(here_m - own_m));
        wrapped(direction(legs[1].to_m) - direction(here_m) - own_rad * length_m / own_m)
    };
    pairs.map(turned).find(|turned_rad| turned_rad.abs() > TURN_RAD)
}

/// An angle between −π and π \[rad\].
pub fn wrapped(angle_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle_rad + PI).rem_euclid(TAU) - PI
}
