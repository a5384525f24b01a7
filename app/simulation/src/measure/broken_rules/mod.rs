//! Rules of the road that vehicles break, with time and place, determined from their driven motion, independently of planners.
//!
//! - **Stop signs**: a vehicle drives past the line of a stop sign without having stood within a car's length of it.
//! - **Traffic lights**: its front passes the line of a red light.
//! - **Right of way**: a vehicle with priority reaches a conflict less than a second of a real car after the vehicle has left it, or is
//!   in it together with the vehicle, although the vehicle was not in it while it could still have yielded.
//! - **Speed limits**: it exceeds the limit of its lane by more than 0.5 m/s of a real car, and has not done so since the start.
//! - **Overtaking** ([`overtaking`]): on a lane of the opposite direction it is beside a vehicle of its own lane that waits in a queue, or
//!   near a zebra crossing, in a junction or before a traffic light.

mod overtaking;

use std::sync::Arc;

use interplay_planners::road::network::{
    ConflictKind, LightColour, LightCycle, Precedence, RightOfWay, RouteConflict, RouteLeg,
};
use interplay_scenarios::{Scenario, Vehicle};

use super::metric::ObservedMoment;
use crate::state::components::to_nanosecond;
use crate::state::frame::{BrokenRule, Event, Frame, Level, RoadRule};
use crate::state::standing::STANDING_MPS;
use overtaking::Overtaking;

/// A real car is speeding if it exceeds a limit by this \[m/s\].
const SPEEDING_MPS: f64 = 0.5;
/// Minimum time between leaving a conflict and the arrival of the vehicle with priority, for a real car \[s\].
const SPARE_S: f64 = 1.0;

/// The broken rules of a run.
#[derive(Clone, Debug)]
pub struct BrokenRules {
    vehicles: Vec<Watched>,
    broken: Vec<BrokenRule>,
}

impl BrokenRules {
    /// Begins with all vehicles at their starts. Violations that exist there, by speed or position, are not counted.
    pub fn new(scenario: &Scenario, start: &ObservedMoment<'_>) -> Self {
        let watched = (0..start.vehicles.len()).map(|vehicle| Watched::new(scenario, start, vehicle));
        BrokenRules { vehicles: watched.collect(), broken: Vec::new() }
    }

    /// The rules that vehicles on the road have broken during a tick, `frame` being its begin and `end` its end.
    pub fn observe(&mut self, frame: &Frame, end: &ObservedMoment<'_>) -> Vec<BrokenRule> {
        let present = self.vehicles.iter_mut().filter(|watched| !frame.vehicles[watched.vehicle].is_absent);
        let found: Vec<BrokenRule> = present
            .flat_map(|watched| {
                let vehicle = watched.vehicle;
                watched.broken_in(frame, end).into_iter().map(move |rule| broken_at(end, vehicle, rule))
            })
            .collect();
        self.broken.extend_from_slice(&found);
        found
    }

    /// All broken rules, in order of time.
    pub fn all(&self) -> &[BrokenRule] {
        &self.broken
    }
}

/// A rule that a vehicle breaks at a time, with its place.
fn broken_at(moment: &ObservedMoment<'_>, vehicle: usize, rule: RoadRule) -> BrokenRule {
    let (stated, state, along_m) = (&moment.vehicles[vehicle], &moment.states[vehicle], moment.along_m[vehicle]);
    let leg = stated.route.leg(along_m);
    BrokenRule {
        time_s: to_nanosecond(moment.time_s),
        vehicle: stated.name.clone(),
        rule,
        x_m: state.x_m,
        y_m: state.y_m,
        lane: leg.map(|leg| leg.lane.clone()),
        along_m: along_m - leg.map_or(0.0, |leg| leg.offset_m),
    }
}

/// The event of a broken rule.
pub(super) fn event(broken: &BrokenRule) -> Event {
    Event { vehicle: broken.vehicle.clone(), level: Level::Warning, text: broken.words() }
}

/// The traffic lights ahead on a vehicle's route.
fn lights(vehicle: &Vehicle, along_m: f64) -> Vec<LightAhead> {
    let front_m = along_m + vehicle.body.front_m;
    let lit = vehicle.route.legs.iter().filter_map(|leg| Some((leg.to_m, leg.light.clone()?)));
    lit.filter(|(line_m, _)| *line_m > front_m).map(|(line_m, cycle)| LightAhead { line_m, cycle }).collect()
}

/// The lines of stop signs on a vehicle's route \[m\].
fn stop_signs(vehicle: &Vehicle) -> Vec<f64> {
    let is_signed =
        |leg: &&RouteLeg| leg.light.is_none() && matches!(leg.right_of_way, RightOfWay::Stop | RightOfWay::AllWayStop);
    vehicle.route.legs.iter().filter(is_signed).map(|leg| leg.to_m).collect()
}

/// Whether the other vehicle has priority at a conflict that only one can occupy.
fn is_theirs(conflict: &RouteConflict) -> bool {
    conflict.precedence == Precedence::Other && conflict.kind != ConflictKind::Diverging
}

/// By how much a speed exceeds the limit of its lane; negative below the limit and without one \[m/s\].
fn speeding_mps(vehicle: &Vehicle, along_m: f64, speed_mps: f64) -> f64 {
    let limit_mps = vehicle.route.leg(along_m).and_then(|leg| leg.speed_limit_mps);
    limit_mps.map_or(f64::NEG_INFINITY, |limit_mps| speed_mps - limit_mps)
}

#[derive(Clone, Copy, Debug)]
struct Sign {
    line_m: f64,
    has_stood: bool,
    is_past: bool,
}

/// The line of a traffic light that a vehicle has not passed.
#[derive(Clone, Debug)]
struct LightAhead {
    line_m: f64,
    cycle: Arc<LightCycle>,
}

/// A conflict at which another vehicle has priority.
#[derive(Clone, Debug)]
struct Crossing {
    other: usize,
    conflict: RouteConflict,
    /// Whether the vehicle had entered it before.
    was_entered: bool,
    /// Time at which the vehicle's rear left it; for merging routes, at which its front reached it \[s\].
    left_s: Option<f64>,
    /// Whether a violation has become impossible.
    is_settled: bool,
}

/// What is known of one vehicle.
#[derive(Clone, Debug)]
struct Watched {
    vehicle: usize,
    /// Ratio of its lengths to those of a real car.
    scale: f64,
    signs: Vec<Sign>,
    lights: Vec<LightAhead>,
    crossings: Vec<Crossing>,
    is_speeding: bool,
    overtaking: Overtaking,
}

impl Watched {
    fn new(scenario: &Scenario, start: &ObservedMoment<'_>, vehicle: usize) -> Self {
        let (stated, along_m) = (&start.vehicles[vehicle], start.along_m[vehicle]);
        let front_m = along_m + stated.body.front_m;
        let sign = |line_m: f64| Sign { line_m, has_stood: false, is_past: front_m > line_m };
        let others = start.vehicles.iter().enumerate().filter(|(other, _)| *other != vehicle);
        let taken = others.flat_map(|(other, theirs)| {
            let conflicts = stated.route.conflicts_with(&theirs.route).filter(|conflict| is_theirs(conflict));
            conflicts.map(move |conflict| Crossing {
                other,
                conflict: conflict.clone(),
                was_entered: false,
                left_s: None,
                is_settled: front_m > conflict.own_line_m,
            })
        });
        Watched {
            vehicle,
            scale: stated.body.real_ratio(),
            signs: stop_signs(stated).into_iter().map(sign).collect(),
            lights: lights(stated, along_m),
            crossings: taken.collect(),
            is_speeding: speeding_mps(stated, along_m, start.states[vehicle].speed_mps) > 0.0,
            overtaking: Overtaking::new(scenario, vehicle),
        }
    }

    /// The rules that the vehicle breaks in a tick.
    fn broken_in(&mut self, frame: &Frame, end: &ObservedMoment<'_>) -> Vec<RoadRule> {
        let (vehicle, along_m) = (&end.vehicles[self.vehicle], end.along_m[self.vehicle]);
        let speed_mps = end.states[self.vehicle].speed_mps;
        let mut broken = Vec::new();
        let excess_mps = speeding_mps(vehicle, along_m, speed_mps);
        let is_fast = excess_mps > SPEEDING_MPS * self.scale.sqrt();
        broken.extend((is_fast && !self.is_speeding).then_some(RoadRule::SpeedLimit));
        self.is_speeding = is_fast || (self.is_speeding && excess_mps > 0.0);
        let front_m = along_m + vehicle.body.front_m;
        let near_m = vehicle.body.front_m + vehicle.body.rear_m;
        for sign in self.signs.iter_mut().filter(|sign| !sign.is_past) {
            sign.has_stood |= speed_mps < STANDING_MPS * self.scale.sqrt() && front_m > sign.line_m - near_m;
            sign.is_past = front_m > sign.line_m + 0.5 * self.scale;
            broken.extend((sign.is_past && !sign.has_stood).then_some(RoadRule::StopSign));
        }
        let passes = |light: &LightAhead| front_m > light.line_m;
        let is_red =
            |light: &LightAhead| matches!(light.cycle.colour_at(end.time_s), LightColour::Red | LightColour::RedAmber);
        let passed_red = self.lights.iter().filter(|light| passes(light) && is_red(light));
        broken.extend(passed_red.map(|_| RoadRule::RedLight));
        self.lights.retain(|light| !passes(light));
        let spare_s = SPARE_S * self.scale.sqrt();
        for crossing in self.crossings.iter_mut().filter(|crossing| !crossing.is_settled) {
            broken.extend(crossing.is_taken(end, self.vehicle, spare_s).then_some(RoadRule::RightOfWay));
        }
        broken.extend(self.overtaking.broken_in(frame, end));
        broken
    }
}

impl Crossing {
    /// Whether the vehicle has violated the other's right of way by now.
    fn is_taken(&mut self, moment: &ObservedMoment<'_>, vehicle: usize, spare_s: f64) -> bool {
        let ends_m = |vehicle: usize| {
            let (along_m, body) = (moment.along_m[vehicle], &moment.vehicles[vehicle].body);
            [along_m - body.rear_m, along_m + body.front_m]
        };
        let ([own_rear_m, own_front_m], [_, their_front_m]) = (ends_m(vehicle), ends_m(self.other));
        let (own_m, their_m) = (self.conflict.own_m, self.conflict.their_m);
        let has_entered = own_front_m > own_m[0];
        if !has_entered {
            return false;
        }
        let is_merging = self.conflict.kind == ConflictKind::Merging;
        if self.left_s.is_none() && (is_merging || own_rear_m > own_m[1]) {
            self.left_s = Some(moment.time_s);
        }
        let within_s = self.left_s.map_or(0.0, |left_s| moment.time_s - left_s);
        let is_there = their_front_m > their_m[0];
        // If the other vehicle entered before this one, its right of way was respected.
        let was_there = !self.was_entered && is_there;
        self.was_entered = true;
        self.is_settled = was_there || is_there || within_s >= spare_s;
        is_there && !was_there && within_s < spare_s
    }
}
