//! The change of lane that a plan makes.

use interplay_planners::State;
use interplay_planners::road::network::{Lane, LaneNeighbour, RoadNetwork};
use interplay_scenarios::{Scenario, Vehicle};

/// A plan changes the lane if it leads over its edge by more than this, in lane widths.
const OVER_THE_LINE_LANES: f64 = 0.1;

/// How far the first of a list of states that is on another lane than the one before it is off that one's centre, positive to
/// the left of the vehicle; none if all stay in their lane, or in those that follow it \[lane widths\].
pub fn lane_change(scenario: &Scenario, vehicle: &Vehicle, states: &[State]) -> Option<f64> {
    match &scenario.network {
        Some(network) => on_network(network, states),
        None => on_parallel_lanes(scenario, vehicle, states),
    }
}

/// On lanes side by side.
fn on_parallel_lanes(scenario: &Scenario, vehicle: &Vehicle, states: &[State]) -> Option<f64> {
    let width_m = scenario.road.lane_width_m();
    let first_m = scenario.road.lane_centre_m(vehicle.road, 0)?;
    let in_lanes = |state: &State| (vehicle.route.locate(state.position(), None).across_m - first_m) / width_m;
    let lane = in_lanes(states.first()?).round();
    states.iter().map(|state| in_lanes(state) - lane).find(|off| off.abs() > 0.5 + OVER_THE_LINE_LANES)
}

/// On a network: over the edge of a lane, or of one that follows it, that has a lane beside it.
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
        let holds = |neighbour: &LaneNeighbour| network.lane(&neighbour.lane).is_some_and(|lane| holds(lane, state));
        if off.abs() > 0.5 + OVER_THE_LINE_LANES && beside.as_ref().is_some_and(holds) {
            // A lane that is driven against its direction has its left on the right of the vehicle.
            return Some(off.copysign(off * libm::cos(state.heading_rad - point.heading_rad)));
        }
    }
    None
}

/// Whether a state is between the ends and the edges of a lane.
fn holds(lane: &Lane, state: &State) -> bool {
    let point = lane.centre.project(state.position(), None);
    (0.0..=lane.centre.length_m()).contains(&point.along_m) && point.across_m.abs() <= lane.half_width_m(point.along_m)
}

/// Of the lanes that follow a lane, the one whose centre is nearest to a state.
fn nearest_successor<'a>(network: &'a RoadNetwork, lane: &Lane, state: &State) -> Option<&'a Lane> {
    let successors = lane.successors.iter().filter_map(|name| network.lane(name));
    let off_m = |lane: &Lane| lane.centre.project(state.position(), None).across_m.abs();
    successors.min_by(|a, b| off_m(a).total_cmp(&off_m(b)))
}
