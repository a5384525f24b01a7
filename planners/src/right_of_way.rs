//! Giving way: where a driver who keeps the rules of the road must wait.
//!
//! Humans and drivers after the intelligent driver model keep them; the planners that interact settle the order themselves.
//! A driver waits at the line before a conflict ([`RouteConflict`])
//!
//! - until it has stood there once, if the sign says so,
//! - while somebody who goes first comes so soon that the driver could not clear the conflict before,
//! - while somebody is in the conflict, or past the own line towards it,
//! - where the first to arrive goes first, while somebody waits who came before.
//!
//! A driver who is past its line, or could no longer stop before it, goes on.

use std::collections::BTreeMap;

use crate::road::network::{ConflictKind, Precedence, RightOfWay, RouteConflict};
use crate::{Agent, Scene};

/// Length of a car at 1/10 scale \[m\].
const CAR_LENGTH_M: f64 = 0.45;

/// A vehicle stands if it would come to rest within this share of a car's length, braking at [`REFERENCE_MPS2`].
const STANDING_LENGTHS: f64 = 0.02;

/// A vehicle that comes within this many lengths of a car of its line has arrived there.
const ARRIVAL_LENGTHS: f64 = 1.0;

/// A driver stops this many lengths of a car before a line.
const STOPPING_LENGTHS: f64 = 0.15;

/// Time to spare between leaving a conflict and the other's arrival there: so often the time `√(length / 1 m/s²)`. For a
/// 4.5 m long car 2.1 s.
const SPARE_TIMES: f64 = 1.0;

/// Acceleration that makes a time of a length \[m/s²\]. At any scale with equal accelerations, times grow alike.
const REFERENCE_MPS2: f64 = 1.0;

/// A driver enters a conflict with this share of its strongest acceleration.
const ENTERING_SHARE: f64 = 0.6;

/// A driver brakes for a line with at most this share of its strongest braking.
const BRAKING_SHARE: f64 = 0.8;

/// What a driver remembers of who has arrived when.
#[derive(Clone, Debug, Default)]
pub(crate) struct ArrivalMemory {
    /// Who has arrived at its line and is not past it.
    arrivals: BTreeMap<String, Arrival>,
    /// The last line at which the driver itself has stood \[m\].
    stood_at_m: Option<f64>,
}

/// The arrival of a vehicle at its line.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    tick: usize,
    line_m: f64,
}

/// A driver and one of the vehicles that it meets.
struct Pair<'a> {
    ego: &'a Agent,
    other: &'a Agent,
    conflict: &'a RouteConflict,
    /// Where the front of the driver is on its route \[m\].
    own_front_m: f64,
    /// Where the front of the other is on its own \[m\].
    their_front_m: f64,
    wanted_mps: f64,
}

impl ArrivalMemory {
    /// How far along its route the front of the planning vehicle may come now; none if nothing holds it \[m\].
    pub(crate) fn stop_line_m(&mut self, scene: &Scene) -> Option<f64> {
        let ego = &scene.ego;
        if !ego.route.is_in_network() {
            return None;
        }
        for other in &scene.others {
            let lines = other.route.conflicts_with(&ego.route).map(|conflict| conflict.own_line_m);
            self.note(other, lines, scene.tick);
        }
        let signs = signed_lines(ego);
        let own_lines = scene.others.iter().flat_map(|other| ego.route.conflicts_with(&other.route));
        self.note(ego, own_lines.map(|conflict| conflict.own_line_m).chain(signs.iter().copied()), scene.tick);
        if let Some(arrival) = self.arrivals.get(&ego.name).filter(|_| is_standing(ego)) {
            self.stood_at_m = Some(arrival.line_m);
        }
        let stop = signs.into_iter().filter(|line_m| self.stood_at_m.is_none_or(|stood_m| stood_m < *line_m));
        let pairs = scene.others.iter().flat_map(|other| {
            let (own_front_m, their_front_m, wanted_mps) = (front_m(ego), front_m(other), scene.goal.target.speed_mps);
            let pair = move |conflict| Pair { ego, other, conflict, own_front_m, their_front_m, wanted_mps };
            ego.route.conflicts_with(&other.route).map(pair)
        });
        let held = pairs.filter(|pair| self.holds(pair)).map(|pair| pair.conflict.own_line_m);
        let before_m = STOPPING_LENGTHS * car_length_m(ego);
        let lines = stop.chain(held).filter(|line_m| can_stop(ego, *line_m - before_m));
        lines.min_by(f64::total_cmp).map(|line_m| line_m - before_m)
    }

    /// Notes whether a vehicle has arrived at one of its lines. It keeps its place in the order until it is past the line.
    fn note(&mut self, agent: &Agent, mut lines: impl Iterator<Item = f64>, tick: usize) {
        let (front_m, near_m) = (front_m(agent), ARRIVAL_LENGTHS * car_length_m(agent));
        self.arrivals.retain(|name, arrival| *name != agent.name || front_m < arrival.line_m);
        if let Some(line_m) = lines.find(|line_m| (0.0..near_m).contains(&(line_m - front_m))) {
            self.arrivals.entry(agent.name.clone()).or_insert(Arrival { tick, line_m });
        }
    }

    /// Whether somebody keeps the driver from a conflict.
    fn holds(&self, pair: &Pair) -> bool {
        let Pair { ego, other, conflict, own_front_m, their_front_m, .. } = *pair;
        if own_front_m > conflict.own_line_m
            || own_front_m - length_m(ego) > conflict.own_m[1]
            || their_front_m - length_m(other) > conflict.their_m[1]
            || ego.shares_lane_with(other)
        {
            return false;
        }
        let is_committed = their_front_m > conflict.their_line_m;
        match conflict.precedence {
            _ if is_committed && conflict.kind != ConflictKind::Merging => pair.comes_too_soon(),
            Precedence::Own => false,
            // Of several who stand and have to let one another pass, the first to arrive goes.
            Precedence::Other => pair.comes_too_soon() || (is_standing(other) && self.came_before(pair) == Some(true)),
            Precedence::ByArrival => self.arrived_later(pair),
        }
    }

    /// Whether the other came to its line before the driver came to its own; none unless both have.
    fn came_before(&self, Pair { ego, other, .. }: &Pair) -> Option<bool> {
        let [own, their] = [ego, other].map(|agent| Some((self.arrivals.get(&agent.name)?.tick, &agent.name)));
        Some(their? < own?)
    }

    /// Whether the other has arrived before the driver, or will.
    fn arrived_later(&self, pair: &Pair) -> bool {
        let Pair { ego, other, conflict, own_front_m, their_front_m, .. } = *pair;
        if let Some(came_before) = self.came_before(pair) {
            return came_before;
        }
        let has_arrived = |agent: &Agent| self.arrivals.contains_key(&agent.name);
        if has_arrived(ego) {
            return their_front_m > conflict.their_line_m;
        }
        let (own_m, their_m) = (conflict.own_line_m - own_front_m, conflict.their_line_m - their_front_m);
        has_arrived(other) || ((their_m, &other.name) < (own_m, &ego.name) && pair.comes_too_soon())
    }
}

impl Pair<'_> {
    /// Whether the other, which may speed up, is in the conflict before the driver could have cleared it, with time to
    /// spare.
    fn comes_too_soon(&self) -> bool {
        let Pair { ego, other, conflict, .. } = self;
        let their_way_m = conflict.their_m[0] - self.their_front_m;
        if their_way_m > 0.0 && is_standing(other) {
            return false;
        }
        let their_mps2 = ENTERING_SHARE * other.limits.acceleration_max_mps2;
        let their_s = time_s(their_way_m.max(0.0), other.state.speed_mps, self.wanted_mps, their_mps2);
        let own_end_m = match conflict.kind {
            // Whoever joins must be as fast as the one behind by then; half of the way is as good as that.
            ConflictKind::Merging => conflict.own_meeting_m,
            ConflictKind::Crossing | ConflictKind::Diverging | ConflictKind::HeadOn => conflict.own_m[1],
        };
        let own_way_m = own_end_m + length_m(ego) - self.own_front_m;
        let own_s =
            time_s(own_way_m, ego.state.speed_mps, self.wanted_mps, ENTERING_SHARE * ego.limits.acceleration_max_mps2);
        their_s < own_s + SPARE_TIMES * (length_m(ego) / REFERENCE_MPS2).sqrt()
    }
}

/// The ends of lanes at which the vehicle must stand once, and has not passed \[m\].
fn signed_lines(agent: &Agent) -> Vec<f64> {
    let front_m = front_m(agent);
    let signed = |sign: RightOfWay| matches!(sign, RightOfWay::Stop | RightOfWay::AllWayStop);
    let legs = agent.route.legs.iter().filter(|leg| signed(leg.right_of_way) && leg.to_m >= front_m);
    legs.map(|leg| leg.to_m).collect()
}

/// Where the front of a vehicle is on its route \[m\].
fn front_m(agent: &Agent) -> f64 {
    agent.route.along(agent.state.position()) + agent.body.front_m
}

fn length_m(agent: &Agent) -> f64 {
    agent.body.front_m + agent.body.rear_m
}

/// The length of a car of the scale of a vehicle, by which distances to lines are measured whatever the vehicle \[m\].
fn car_length_m(agent: &Agent) -> f64 {
    CAR_LENGTH_M * agent.body.scale
}

fn is_standing(agent: &Agent) -> bool {
    let speed_mps = agent.state.speed_mps;
    speed_mps * speed_mps < 2.0 * REFERENCE_MPS2 * STANDING_LENGTHS * car_length_m(agent)
}

/// Whether a vehicle can stop before a place.
fn can_stop(agent: &Agent, place_m: f64) -> bool {
    let speed_mps = agent.state.speed_mps;
    let braking_m = speed_mps * speed_mps / (2.0 * BRAKING_SHARE * agent.limits.acceleration_min_mps2.abs());
    // Whoever stands a little beyond still waits.
    front_m(agent) + braking_m <= place_m + STOPPING_LENGTHS * car_length_m(agent)
}

/// The time for a way from a speed on, with a constant acceleration up to a wanted speed \[s\].
fn time_s(way_m: f64, speed_mps: f64, wanted_mps: f64, acceleration_mps2: f64) -> f64 {
    let most_mps = wanted_mps.max(speed_mps);
    let until_s = (most_mps - speed_mps) / acceleration_mps2;
    let until_m = 0.5 * (speed_mps + most_mps) * until_s;
    if way_m <= until_m {
        let root = (speed_mps * speed_mps + 2.0 * acceleration_mps2 * way_m.max(0.0)).sqrt();
        return (root - speed_mps) / acceleration_mps2;
    }
    if most_mps > 0.0 { until_s + (way_m - until_m) / most_mps } else { f64::INFINITY }
}
