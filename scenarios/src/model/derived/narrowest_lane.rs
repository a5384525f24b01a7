//! The narrowest lane on the route of a vehicle.

use interplay_planners::road::network::{ConflictKind, Lane, RoadNetwork, RouteLeg};
use interplay_planners::{Axes, Route, State};

use crate::model::scenario::{Scenario, Vehicle};
use crate::model::traffic::lane_reference::LaneReference;
use crate::roads::{Branch, Road};

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

/// A region where the routes of two vehicles overlap without being the same lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConflictZone {
    /// Its interval along the route of the first vehicle \[m\].
    pub first_m: [f64; 2],
    /// Its interval along the route of the second \[m\].
    pub second_m: [f64; 2],
    /// The interval from where the front of the first enters the route of the second to where its rear has left it \[m\]; where routes
    /// merge, the position of the merge.
    pub first_way_m: [f64; 2],
    /// The same for the second \[m\].
    pub second_way_m: [f64; 2],
}

impl Road {
    /// The regions where the routes of two vehicles cross, merge or meet head-on, in the order of the first one's route; empty
    /// if both drive along one road.
    ///
    /// Routes of one network store where they meet: a zone begins where their centre lines meet, since a vehicle that waits before
    /// that point, with its front in the outer part of the other's lane, lets the other pass. On an intersection of two roads, the zone is
    /// their overlap.
    pub fn conflict_zones(&self, first: &Vehicle, second: &Vehicle) -> Vec<ConflictZone> {
        if first.route.is_in_network() && second.route.is_in_network() {
            let conflicts = first.route.conflicts_with(&second.route);
            return conflicts
                .map(|conflict| ConflictZone {
                    first_m: [conflict.own_meeting_m, conflict.own_m[1]],
                    second_m: [conflict.their_meeting_m, conflict.their_m[1]],
                    first_way_m: way_m(conflict.kind, conflict.own_m, conflict.own_meeting_m),
                    second_way_m: way_m(conflict.kind, conflict.their_m, conflict.their_meeting_m),
                })
                .collect();
        }
        let zones = self.conflict_zone_m(first.road).zip(self.conflict_zone_m(second.road));
        let zones = zones.filter(|_| first.road != second.road);
        let zone =
            |(first_m, second_m)| ConflictZone { first_m, second_m, first_way_m: first_m, second_way_m: second_m };
        zones.map(zone).into_iter().collect()
    }
}

/// The part of a route on which a vehicle blocks another one that drives through a conflict \[m\].
fn way_m(kind: ConflictKind, overlap_m: [f64; 2], meeting_m: f64) -> [f64; 2] {
    match kind {
        ConflictKind::Merging => [meeting_m; 2],
        ConflictKind::Crossing | ConflictKind::Diverging | ConflictKind::HeadOn => overlap_m,
    }
}

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
