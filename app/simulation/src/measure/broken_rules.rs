//! Rules of the road that vehicles break, with time and place, determined from its driven motion, independently of planners.
//!
//! - **Stop signs**: it drives past the line of a stop sign without having stood within a car's length of it.
//! - **Traffic lights**: its front passes the line of a red light.
//! - **Right of way**: a vehicle with priority reaches a conflict less than a second of a real car after the vehicle has left it, or is
//!   in it together with the vehicle, although the vehicle was not in it while it could still have yielded.
//! - **Speed limits**: it exceeds the limit of its lane by more than 0.5 m/s of a real car, and has not done so since the start.

use std::sync::Arc;

use interplay_planners::road::network::{
    ConflictKind, LightColour, LightCycle, Precedence, RightOfWay, RouteConflict, RouteLeg,
};
use interplay_scenarios::Vehicle;

use crate::measure::metric::ObservedMoment;
use crate::state::components::to_nanosecond;
use crate::state::frame::{BrokenRule, Event, Level, RoadRule};
use crate::state::standing::STANDING_MPS;

/// A real car is speeding if it exceeds a limit by this \[m/s\].
const SPEEDING_MPS: f64 = 0.5;
/// Minimum time between leaving a conflict and the arrival of the vehicle with priority, for a real car \[s\].
const SPARE_S: f64 = 1.0;

/// A line at the end of a lane belongs to that lane: a place is looked up this far before it \[m\].
const BEFORE_LINE_M: f64 = 1e-3;

/// Watches which rules the vehicles of a run break.
#[derive(Clone, Debug)]
pub struct RuleWatch {
    /// For each vehicle, what it can still break.
    watched: Vec<WatchedVehicle>,
}

impl RuleWatch {
    /// The vehicles at their starts. A limit that is exceeded and a line that is passed at the start do not count.
    pub fn new(start: &ObservedMoment<'_>) -> Self {
        RuleWatch { watched: (0..start.vehicles.len()).map(|vehicle| WatchedVehicle::new(start, vehicle)).collect() }
    }

    /// The rules that the vehicles break in a tick that ends at `end`; vehicles that `are_absent` break none.
    pub fn observe(&mut self, end: &ObservedMoment<'_>, are_absent: impl Fn(usize) -> bool) -> Vec<BrokenRule> {
        let mut broken = Vec::new();
        for watched in self.watched.iter_mut().filter(|watched| !are_absent(watched.vehicle)) {
            watched.observe(end, &mut broken);
        }
        broken
    }
}

/// The event of a rule that is broken, for the log.
pub fn event(broken: &BrokenRule) -> Event {
    Event { vehicle: broken.vehicle.clone(), level: Level::Warning, text: broken.words() }
}

impl WatchedVehicle {
    fn new(start: &ObservedMoment<'_>, vehicle: usize) -> Self {
        let stated = &start.vehicles[vehicle];
        let front_m = start.along_m[vehicle] + stated.body.front_m;
        let signs = stop_signs(stated).into_iter();
        let others = start.vehicles.iter().enumerate().filter(|(other, _)| *other != vehicle);
        let crossings = others.flat_map(|(other, theirs)| {
            let conflicts = stated.route.conflicts_with(&theirs.route).filter(|conflict| is_theirs(conflict));
            conflicts.map(move |conflict| Crossing {
                other,
                conflict: conflict.clone(),
                was_entered: false,
                left_s: None,
                is_settled: front_m > conflict.own_line_m,
            })
        });
        WatchedVehicle {
            vehicle,
            scale: stated.body.real_ratio(),
            signs: signs.map(|line_m| Sign { line_m, has_stood: false, is_past: front_m > line_m }).collect(),
            lights: lights(stated, start.along_m[vehicle]),
            crossings: crossings.collect(),
            is_speeding: speeding_mps(stated, start.along_m[vehicle], start.states[vehicle].speed_mps) > 0.0,
        }
    }
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

/// What one vehicle can still break.
#[derive(Clone, Debug)]
struct WatchedVehicle {
    vehicle: usize,
    /// Ratio of its lengths to those of a real car.
    scale: f64,
    signs: Vec<Sign>,
    lights: Vec<LightAhead>,
    crossings: Vec<Crossing>,
    is_speeding: bool,
}

impl WatchedVehicle {
    fn observe(&mut self, end: &ObservedMoment<'_>, broken: &mut Vec<BrokenRule>) {
        let (vehicle, along_m) = (&end.vehicles[self.vehicle], end.along_m[self.vehicle]);
        let speed_mps = end.states[self.vehicle].speed_mps;
        let mut add = |rule: RoadRule, at_m: f64, of: Option<usize>| {
            let leg = vehicle.route.leg(at_m - BEFORE_LINE_M);
            broken.push(BrokenRule {
                time_s: to_nanosecond(end.time_s),
                vehicle: vehicle.name.clone(),
                rule,
                of: of.map(|other| end.vehicles[other].name.clone()),
                lane: leg.map(|leg| leg.lane.clone()),
                along_m: leg.map_or(at_m, |leg| at_m - leg.offset_m),
            });
        };
        let excess_mps = speeding_mps(vehicle, along_m, speed_mps);
        let is_fast = excess_mps > SPEEDING_MPS * self.scale.sqrt();
        if is_fast && !self.is_speeding {
            add(RoadRule::SpeedLimit, along_m, None);
        }
        self.is_speeding = is_fast || (self.is_speeding && excess_mps > 0.0);
        let front_m = along_m + vehicle.body.front_m;
        let near_m = vehicle.body.front_m + vehicle.body.rear_m;
        for sign in self.signs.iter_mut().filter(|sign| !sign.is_past) {
            sign.has_stood |= speed_mps < STANDING_MPS * self.scale.sqrt() && front_m > sign.line_m - near_m;
            sign.is_past = front_m > sign.line_m + 0.5 * self.scale;
            if sign.is_past && !sign.has_stood {
                add(RoadRule::StopSign, sign.line_m, None);
            }
        }
        let is_red =
            |light: &&LightAhead| matches!(light.cycle.colour_at(end.time_s), LightColour::Red | LightColour::RedAmber);
        for light in self.lights.iter().filter(|light| front_m > light.line_m).filter(is_red) {
            add(RoadRule::RedLight, light.line_m, None);
        }
        self.lights.retain(|light| front_m <= light.line_m);
        let spare_s = SPARE_S * self.scale.sqrt();
        for crossing in self.crossings.iter_mut().filter(|crossing| !crossing.is_settled) {
            if crossing.is_taken(end, self.vehicle, spare_s) {
                add(RoadRule::RightOfWay, crossing.conflict.own_m[0], Some(crossing.other));
            }
        }
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
