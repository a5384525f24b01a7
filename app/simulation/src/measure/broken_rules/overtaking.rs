//! Overtaking where it is forbidden.
//!
//! A vehicle overtakes while a part of it is on a lane of the opposite direction and it is beside a vehicle that drives, or waits, in the
//! lane of its route. Vehicles that do not want to move, such as parked ones, are passed and not overtaken.

use interplay_planners::road::network::{ConflictKind, Lane};
use interplay_planners::{Route, State};
use interplay_scenarios::{Scenario, Vehicle};

use crate::measure::lane_use::LaneLines;
use crate::measure::metric::ObservedMoment;
use crate::state::frame::{Frame, RoadRule};
use crate::state::standing::{Standing, wants_to_drive};

/// Overtaking is forbidden within this distance before a zebra crossing, for a real car \[m\].
const BEFORE_ZEBRA_M: f64 = 20.0;
/// Overtaking is forbidden within this distance before a traffic light, for a real car \[m\].
const BEFORE_LIGHT_M: f64 = 30.0;
/// Distance between the places of a zebra crossing that are compared with a route, for a real car \[m\].
const ZEBRA_STEP_M: f64 = 0.5;

/// A stretch of a route on which overtaking is forbidden.
#[derive(Clone, Copy, Debug)]
struct NoOvertaking {
    /// From and to, along the route \[m\].
    along_m: [f64; 2],
    rule: RoadRule,
}

/// The overtaking of one vehicle.
#[derive(Clone, Debug)]
pub(super) struct Overtaking {
    vehicle: usize,
    lines: LaneLines,
    forbidden: Vec<NoOvertaking>,
    /// The vehicles beside it that it overtakes in breach of a rule that has been counted.
    counted: Vec<usize>,
}

impl Overtaking {
    pub fn new(scenario: &Scenario, vehicle: usize) -> Self {
        let own = &scenario.vehicles[vehicle];
        let lines = LaneLines::of(scenario, own);
        Overtaking { vehicle, lines, forbidden: forbidden(scenario, own), counted: Vec::new() }
    }

    /// The rules that the vehicle breaks by overtaking in a tick.
    pub fn broken_in(&mut self, frame: &Frame, end: &ObservedMoment<'_>) -> Vec<RoadRule> {
        let own = end.of(self.vehicle);
        let is_driven = own.vehicle.obstacle.is_none();
        if !is_driven || !self.lines.used_by(own.vehicle, own.state, own.along_m).is_oncoming {
            self.counted.clear();
            return Vec::new();
        }
        let others = (0..end.vehicles.len()).filter(|other| *other != self.vehicle);
        let is_overtaken = |other: &usize| {
            let theirs = &end.vehicles[*other];
            !frame.vehicles[*other].is_absent
                && wants_to_drive(theirs)
                && is_beside([own.vehicle, theirs], own.along_m, &end.states[*other])
        };
        let beside: Vec<usize> = others.filter(is_overtaken).collect();
        self.counted.retain(|other| beside.contains(other));
        let standing = Standing::of(end.vehicles, frame);
        let is_here = |stretch: &&NoOvertaking| {
            own.along_m + own.vehicle.body.front_m > stretch.along_m[0]
                && own.along_m - own.vehicle.body.rear_m < stretch.along_m[1]
        };
        let here = self.forbidden.iter().find(is_here).map(|stretch| stretch.rule);
        let mut broken = Vec::new();
        for other in beside {
            let rule = if standing.queues(other) { Some(RoadRule::OvertakingQueue) } else { here };
            if let Some(rule) = rule.filter(|_| !self.counted.contains(&other)) {
                self.counted.push(other);
                broken.push(rule);
            }
        }
        broken
    }
}

/// Whether the second vehicle drives in the lane of the first one's route, beside the first one, in the same direction.
fn is_beside([own, theirs]: [&Vehicle; 2], own_m: f64, state: &State) -> bool {
    let at = own.route.locate(state.position(), Some(own_m));
    let ahead_m = at.along_m - own_m;
    let is_along = libm::cos(state.heading_rad - at.heading_rad) > std::f64::consts::FRAC_1_SQRT_2;
    let overlaps = ahead_m < own.body.front_m + theirs.body.rear_m && -ahead_m < own.body.rear_m + theirs.body.front_m;
    is_along && overlaps && at.across_m.abs() < own.route.half_width.value(at.along_m)
}

/// The stretches of a vehicle's route on which overtaking is forbidden.
fn forbidden(scenario: &Scenario, vehicle: &Vehicle) -> Vec<NoOvertaking> {
    let (route, scale) = (&vehicle.route, vehicle.body.real_ratio());
    let lanes = scenario.network.iter().flat_map(|network| network.lanes());
    let zebras = lanes.filter(|lane| lane.is_zebra).filter_map(|lane| crossed_m(route, lane, scale));
    let zebras = zebras.map(|[from_m, to_m]| NoOvertaking {
        along_m: [from_m - BEFORE_ZEBRA_M * scale, to_m],
        rule: RoadRule::OvertakingAtZebra,
    });
    let lit = route.legs.iter().filter(|leg| leg.light.is_some());
    let lights = lit.map(|leg| NoOvertaking {
        along_m: [leg.to_m - BEFORE_LIGHT_M * scale, leg.to_m],
        rule: RoadRule::OvertakingBeforeLight,
    });
    let roads = scenario.vehicles.iter().filter(|other| !other.route.legs.iter().any(|leg| leg.is_zebra));
    let conflicts = roads.flat_map(|other| route.conflicts_with(&other.route));
    let junctions = conflicts.filter(|conflict| conflict.kind == ConflictKind::Crossing);
    let junctions =
        junctions.map(|conflict| NoOvertaking { along_m: conflict.own_m, rule: RoadRule::OvertakingInJunction });
    zebras.chain(lights).chain(junctions).collect()
}

/// Where a route runs over a lane that crosses it, from and to \[m\]; none if it does not.
fn crossed_m(route: &Route, lane: &Lane, scale: f64) -> Option<[f64; 2]> {
    let length_m = lane.centre.length_m();
    let count = (length_m / (ZEBRA_STEP_M * scale)).ceil().max(1.0);
    let places = (0..=count as usize).map(|index| {
        let along_m = length_m * index as f64 / count;
        let at = route.locate(lane.centre.at(along_m).position, None);
        (at, lane.half_width_m(along_m))
    });
    let on_route = places.filter(|(at, _)| {
        (0.0..=route.end_m()).contains(&at.along_m) && at.across_m.abs() <= route.half_width.value(at.along_m)
    });
    on_route.fold(None, |found: Option<[f64; 2]>, (at, half_m)| {
        let [from_m, to_m] = [at.along_m - half_m, at.along_m + half_m];
        Some(found.map_or([from_m, to_m], |[low_m, high_m]| [low_m.min(from_m), high_m.max(to_m)]))
    })
}
