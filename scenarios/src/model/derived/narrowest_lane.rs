//! The narrowest lane on the route of a vehicle.

use interplay_planners::road::network::{Lane, RoadNetwork, RouteLeg};
use interplay_planners::{Route, State};

use crate::model::scenario::{Scenario, Vehicle};
use crate::roads::Road;

/// The narrowest position of the lanes on the route of a vehicle, from its start on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NarrowestLane {
    /// Width there \[m\].
    pub width_m: f64,
    /// The name of the lane, and the position along it \[m\]; `None` on a road of parallel lanes, which are equally wide.
    pub place: Option<(String, f64)>,
    /// The key below `road` that states the width.
    pub key: String,
}

/// The narrowest position of the lanes on the route of a vehicle, from its start on. Where it changes lanes, one of them may begin or
/// end in a point: of a lane that it leaves this way only the start of its part counts, and of one that it enters, only the end.
pub(crate) fn narrowest_lane(scenario: &Scenario, vehicle: &Vehicle) -> NarrowestLane {
    narrowest_lane_of(&scenario.road, scenario.network.as_deref(), &vehicle.start, &vehicle.route)
}

/// The same for a road with its network, if any, and a vehicle of which only the start and the route are known.
pub(crate) fn narrowest_lane_of(
    road: &Road,
    network: Option<&RoadNetwork>,
    start: &State,
    route: &Route,
) -> NarrowestLane {
    let found = network.and_then(|network| on_network(network, start, route));
    let (width_m, place) =
        found.map_or((road.lane_width_m(), None), |(lane, along_m, width_m)| (width_m, Some((lane, along_m))));
    let lane = place.as_ref().map_or("", |(lane, _)| lane);
    NarrowestLane { width_m, key: road.width_key(lane), place }
}

/// The lane, the position on it and its width there \[m\].
fn on_network(network: &RoadNetwork, start: &State, route: &Route) -> Option<(String, f64, f64)> {
    let legs = &route.legs;
    let start_m = route.along(start.position());
    let places = legs.iter().enumerate().filter(|(_, leg)| leg.to_m > start_m).flat_map(|(index, leg)| {
        let before = index.checked_sub(1).and_then(|before| legs.get(before)).filter(|before| before.to_m > start_m);
        let is_entered = before.is_some_and(|before| !follows(network, before, leg));
        let is_left = legs.get(index + 1).is_some_and(|after| !follows(network, leg, after));
        let lane = network.lane(&leg.lane);
        lane.into_iter().flat_map(move |lane| places_of(lane, leg, start_m, [is_entered, is_left]))
    });
    places.min_by(|one, other| one.2.total_cmp(&other.2))
}

fn places_of(
    lane: &Lane,
    leg: &RouteLeg,
    start_m: f64,
    [is_entered, is_left]: [bool; 2],
) -> impl Iterator<Item = (String, f64, f64)> {
    let [from_m, to_m] =
        [leg.from_m.max(start_m), leg.to_m].map(|along_m| (along_m - leg.offset_m).clamp(0.0, lane.centre.length_m()));
    let knots_m = lane.width.stretches().iter().flat_map(|stretch| [stretch.from_m, stretch.to_m]);
    let inside_m = knots_m.filter(move |along_m| !is_entered && !is_left && (from_m..=to_m).contains(along_m));
    let begin_m = (!is_entered).then_some(from_m);
    let end_m = (!is_left).then_some(to_m);
    // A width is monotone between its knots.
    let all_m = begin_m.into_iter().chain(inside_m).chain(end_m);
    all_m.map(|along_m| (lane.name.clone(), along_m, lane.width.value(along_m)))
}

/// Whether a lane follows another one without a change of lane.
fn follows(network: &RoadNetwork, before: &RouteLeg, after: &RouteLeg) -> bool {
    network.lane(&before.lane).is_some_and(|lane| lane.successors.contains(&after.lane))
}
