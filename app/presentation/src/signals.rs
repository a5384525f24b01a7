//! Brake lights and indicators of vehicles, from their accelerations and plans.

use std::sync::Arc;

use interplay_planners::road::network::{Lane, LaneNeighbour, LightColour, LightCycle, RoadNetwork, RouteLeg};
use interplay_planners::scene::IndicatorSide;
use interplay_planners::{Route, State};
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::VehicleFrame;

use crate::palette::{Colour, VERMILLION};

/// A vehicle brakes visibly if its acceleration is below this \[m/s²\].
const BRAKING_MPS2: f64 = -0.1;
/// A route that turns by more than this at a junction is indicated \[rad\].
const TURN_RAD: f64 = 0.6;
/// How far ahead a turn is indicated, in lane widths.
const TURN_AHEAD_LANES: f64 = 5.0;
/// Time before crossing the line from which a lane change is indicated \[s\], at 1/10 scale: 3 s of a real car.
const LANE_CHANGE_AHEAD_S: f64 = 1.0;

/// Whether an acceleration lights the brake lights.
pub fn is_braking(acceleration_mps2: f64) -> bool {
    acceleration_mps2 < BRAKING_MPS2
}

/// The side on which a vehicle indicates, if it changes the lane or turns on a network. Among people the change of lane is part of their
/// state; in other files, where plans are told, it is that of the plan.
pub fn indicator_side(scenario: &Scenario, vehicle: &Vehicle, seen: &VehicleFrame) -> Option<IndicatorSide> {
    let states = &seen.plan.trajectory.states;
    let ahead = (LANE_CHANGE_AHEAD_S * vehicle.body.time_ratio() / scenario.step_s).ceil() as usize;
    if !vehicle.tells_plan() && seen.indicator.is_some() {
        return seen.indicator;
    }
    let told = if vehicle.tells_plan() { &states[..states.len().min(ahead + 1)] } else { &[] };
    let to_another_lane = lane_change(scenario, vehicle, told);
    let along_m = vehicle.route.along(seen.state.position());
    let leftward = to_another_lane.or_else(|| turned_rad(scenario, &vehicle.route, along_m))?;
    Some(if leftward > 0.0 { IndicatorSide::Left } else { IndicatorSide::Right })
}

/// The angle by which the route turns where the next lane with several successors ends, if that is near \[rad\].
///
/// The bend of the lane itself does not count: on a ring, a successor with the same bend leads straight on.
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

/// A plan changes the lane if it crosses the edge by more than this, in lane widths.
const OVER_THE_LINE_LANES: f64 = 0.1;

/// The lateral offset of the first state in another lane from the centre of the lane before, positive to the left of the vehicle
/// \[lane widths\]; `None` if all states stay in the first lane and its successors.
pub fn lane_change(scenario: &Scenario, vehicle: &Vehicle, states: &[State]) -> Option<f64> {
    match &scenario.network {
        Some(network) => on_network(network, states),
        None => on_parallel_lanes(scenario, vehicle, states),
    }
}

fn on_parallel_lanes(scenario: &Scenario, vehicle: &Vehicle, states: &[State]) -> Option<f64> {
    let width_m = scenario.road.lane_width_m();
    let first_m = scenario.road.lane_centre_m(vehicle.road, 0)?;
    let in_lanes = |state: &State| (vehicle.route.locate(state.position(), None).across_m - first_m) / width_m;
    let lane = in_lanes(states.first()?).round();
    states.iter().map(|state| in_lanes(state) - lane).find(|off| off.abs() > 0.5 + OVER_THE_LINE_LANES)
}

/// Looks for the first state beyond an edge with a neighbouring lane, along the first lane and its successors.
fn on_network(network: &RoadNetwork, states: &[State]) -> Option<f64> {
    let first = states.first()?;
    let place = network.locate(first.position(), first.heading_rad).into_iter().next()?;
    let mut lane = network.lane(&place.lane)?;
    for state in states {
        let mut point = lane.centre.project(state.position(), None);
        if point.along_m > lane.centre.length_m() {
            lane = nearest_successor(network, lane, state)?;
            point = lane.centre.project(state.position(), None);
        }
        let off = point.across_m / lane.width.value(point.along_m);
        let beside: &Option<LaneNeighbour> = if off > 0.0 { &lane.left } else { &lane.right };
        let holds = |neighbour: &LaneNeighbour| network.lane(&neighbour.lane).is_some_and(|lane| contains(lane, state));
        if off.abs() > 0.5 + OVER_THE_LINE_LANES && beside.as_ref().is_some_and(holds) {
            // In a lane that is driven against its direction, its left is the right of the vehicle.
            return Some(off.copysign(off * libm::cos(state.heading_rad - point.heading_rad)));
        }
    }
    None
}

/// Whether a state is within a lane.
fn contains(lane: &Lane, state: &State) -> bool {
    let point = lane.centre.project(state.position(), None);
    (0.0..=lane.centre.length_m()).contains(&point.along_m) && point.across_m.abs() <= lane.half_width_m(point.along_m)
}

/// The successor of a lane whose centre is nearest to a state.
fn nearest_successor<'a>(network: &'a RoadNetwork, lane: &Lane, state: &State) -> Option<&'a Lane> {
    let successors = lane.successors.iter().filter_map(|name| network.lane(name));
    let off_m = |lane: &Lane| lane.centre.project(state.position(), None).across_m.abs();
    successors.min_by(|a, b| off_m(a).total_cmp(&off_m(b)))
}

const RED: Colour = VERMILLION.rgb;
const AMBER: Colour = [0xF5, 0xB8, 0x2E];
const GREEN: Colour = [0x3D, 0xD6, 0x8C];
const OFF: Colour = [0x70, 0x74, 0x7A];

/// The light at the end of a lane.
#[derive(Clone, Debug, PartialEq)]
pub struct LightShape {
    pub lane: String,
    /// The ends of the bar, on the right and on the left of the lane \[m\].
    pub bar: [[f64; 2]; 2],
    pub cycle: Arc<LightCycle>,
}

impl LightShape {
    pub fn all(network: &RoadNetwork) -> Vec<LightShape> {
        let lit = network.lanes().iter().filter_map(|lane| Some((lane, lane.light.as_ref()?)));
        let shape = |(lane, cycle): (&Lane, &Arc<LightCycle>)| {
            let end_m = lane.centre.length_m();
            let half_m = lane.half_width_m(end_m);
            let bar = [-half_m, half_m].map(|across_m| lane.centre.position(end_m, across_m));
            LightShape { lane: lane.name.clone(), bar, cycle: Arc::clone(cycle) }
        };
        lit.map(shape).collect()
    }

    /// The colour at a time \[s\].
    pub fn colour_at(&self, time_s: f64) -> Colour {
        match self.cycle.colour_at(time_s) {
            LightColour::Red => RED,
            LightColour::RedAmber | LightColour::Amber => AMBER,
            LightColour::Green => GREEN,
            LightColour::Off => OFF,
        }
    }
}
