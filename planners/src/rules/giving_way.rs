//! Whether one vehicle has to wait for another one where their routes meet, by which vehicles have arrived.
//!
//! The rules that all vehicles are judged by (`rules`) and drivers who only keep the right of way (`right_of_way`) ask it; they differ in
//! whom they remember, and in who counts as standing.

use crate::Agent;
use crate::road::network::{ConflictKind, Precedence, RightOfWay, RouteConflict};

/// Length of a car at 1/10 scale \[m\].
const CAR_LENGTH_M: f64 = 0.45;

/// A driver stops this many lengths of a car before a line.
const STOPPING_LENGTHS: f64 = 0.15;

/// Time to spare between leaving a conflict and the other's arrival there: so often the time `√(length / 1 m/s²)`. For a
/// 4.5 m long car 2.1 s.
const SPARE_TIMES: f64 = 1.0;

/// Acceleration that makes a time of a length \[m/s²\]. At any scale with equal accelerations, times grow alike.
const REFERENCE_MPS2: f64 = 1.0;

/// A driver enters a conflict with this share of its strongest acceleration.
pub(crate) const ENTERING_SHARE: f64 = 0.6;

/// A driver brakes for a line with at most this share of its strongest braking.
const BRAKING_SHARE: f64 = 0.8;

/// Gap at standstill, of real vehicles \[m\].
pub(super) const STANDSTILL_M: f64 = 2.0;
/// Time gap ahead and behind, of real vehicles \[s\]: that of one in twenty recorded people is shorter.
pub(super) const TIME_GAP_S: f64 = 0.8;
/// What the vehicle behind one that joins may have to brake \[m/s²\].
pub(super) const LAG_BRAKING_MPS2: f64 = 1.5;

/// Pieces of constant acceleration of a way through curves.
const WAY_PIECES: usize = 32;

/// A vehicle and one of those that it meets, at one of their conflicts.
pub(crate) struct Pair<'a> {
    ego: &'a Agent,
    other: &'a Agent,
    conflict: &'a RouteConflict,
    /// Where the front of the vehicle is on its route \[m\].
    own_front_m: f64,
    /// Where the front of the other is on its own \[m\].
    their_front_m: f64,
    wanted_mps: f64,
    /// Whether the other stands.
    they_stand: bool,
}

/// What the order of arrival says of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Arrived {
    /// Whether the vehicle is at its line.
    pub own: bool,
    /// Whether the other is at its line.
    pub their: bool,
    /// Whether the other came to its line before the vehicle came to its own; none unless both have.
    pub they_came_first: Option<bool>,
    /// Whether the other goes as soon as it may, if it stands.
    pub they_are_ready: bool,
    /// Whether the other goes first if both are as far from their lines.
    pub they_win_ties: bool,
}

impl<'a> Pair<'a> {
    /// A vehicle that wants to drive at some speed, and another one, which stands or not.
    pub(crate) fn new(
        [ego, other]: [&'a Agent; 2],
        conflict: &'a RouteConflict,
        wanted_mps: f64,
        they_stand: bool,
    ) -> Self {
        Pair { ego, other, conflict, own_front_m: front_m(ego), their_front_m: front_m(other), wanted_mps, they_stand }
    }

    /// Whether the other keeps the vehicle from the conflict.
    pub(crate) fn holds(&self, arrived: Arrived) -> bool {
        let Pair { ego, other, conflict, own_front_m, their_front_m, .. } = *self;
        if own_front_m > conflict.own_line_m
            || own_front_m - length_m(ego) > conflict.own_m[1]
            || their_front_m - length_m(other) > conflict.their_m[1]
            || ego.shares_lane_with(other)
        {
            return false;
        }
        let is_committed = their_front_m > conflict.their_line_m;
        match conflict.precedence {
            _ if is_committed && conflict.kind != ConflictKind::Merging => self.comes_too_soon(),
            Precedence::Own => false,
            // A vehicle with priority that stands at its line waits for a third one, and goes when that one has passed.
            Precedence::Other => self.comes_too_soon() || (self.they_stand && arrived.they_are_ready),
            Precedence::ByArrival => self.arrived_later(arrived),
        }
    }

    /// Whether the other has arrived before the vehicle, or will.
    fn arrived_later(&self, arrived: Arrived) -> bool {
        if let Some(they_came_first) = arrived.they_came_first {
            return they_came_first;
        }
        if arrived.own {
            return self.their_front_m > self.conflict.their_line_m;
        }
        let own_m = self.conflict.own_line_m - self.own_front_m;
        let their_m = self.conflict.their_line_m - self.their_front_m;
        let is_nearer = their_m < own_m || (their_m == own_m && arrived.they_win_ties);
        arrived.their || (is_nearer && self.comes_too_soon())
    }

    /// Whether the other, which may speed up, is in the conflict before the vehicle could have cleared it, with time to
    /// spare.
    fn comes_too_soon(&self) -> bool {
        let Pair { ego, other, conflict, .. } = self;
        let their_way_m = conflict.their_m[0] - self.their_front_m;
        if their_way_m > 0.0 && self.they_stand {
            return false;
        }
        let their_mps2 = ENTERING_SHARE * other.limits.acceleration_max_mps2;
        let their_s = time_s(their_way_m.max(0.0), other.state.speed_mps, self.wanted_mps, their_mps2);
        let own_end_m = match conflict.kind {
            // The vehicle that joins must be as fast as the one behind by then; half of the way is as good as that.
            ConflictKind::Merging => conflict.own_meeting_m,
            ConflictKind::Crossing | ConflictKind::Diverging | ConflictKind::HeadOn => conflict.own_m[1],
        };
        let own_way_m = own_end_m + length_m(ego) - self.own_front_m;
        let own_mps2 = ENTERING_SHARE * ego.limits.acceleration_max_mps2;
        let spare_s = SPARE_TIMES * (length_m(ego) / REFERENCE_MPS2).sqrt();
        let own_s = time_s(own_way_m, ego.state.speed_mps, self.wanted_mps, own_mps2);
        if their_s < own_s + spare_s || ego.limits.comfort.is_none() {
            return their_s < own_s + spare_s;
        }
        let (own_s, own_mps) = through_curves(ego, own_way_m, self.wanted_mps, own_mps2);
        let closing_s = match conflict.kind {
            ConflictKind::Merging => closing_s(other, own_mps, own_mps2),
            ConflictKind::Crossing | ConflictKind::Diverging | ConflictKind::HeadOn => 0.0,
        };
        their_s < own_s + spare_s.max(closing_s)
    }
}

/// The time for a way along a vehicle's route, no faster than limits and curves permit, and the speed at its end \[s, m/s\].
fn through_curves(agent: &Agent, way_m: f64, wanted_mps: f64, acceleration_mps2: f64) -> (f64, f64) {
    let from_m = agent.along_m();
    let (mut time_s, mut speed_mps) = (0.0, agent.state.speed_mps);
    let most_mps = wanted_mps.max(speed_mps);
    let piece_m = way_m.max(0.0) / WAY_PIECES as f64;
    for piece in 1..=WAY_PIECES {
        let permitted_mps = agent.permitted_speed_mps(from_m + piece as f64 * piece_m).unwrap_or(f64::INFINITY);
        let faster_mps = (speed_mps * speed_mps + 2.0 * acceleration_mps2 * piece_m).sqrt();
        let next_mps = faster_mps.min(permitted_mps).min(most_mps);
        time_s += 2.0 * piece_m / (speed_mps + next_mps).max(f64::MIN_POSITIVE);
        speed_mps = next_mps;
    }
    (time_s, speed_mps)
}

/// How long after a vehicle joins its lane another one may come there, so that it keeps its time gap and brakes little while the first is
/// slower and speeds up \[s\].
fn closing_s(behind: &Agent, joining_mps: f64, gaining_mps2: f64) -> f64 {
    let (ratio, speed_mps) = (behind.body.real_ratio(), behind.state.speed_mps);
    let slower_mps = (speed_mps - joining_mps).max(0.0);
    let closed_m = slower_mps * slower_mps / (2.0 * (LAG_BRAKING_MPS2 + gaining_mps2));
    TIME_GAP_S * ratio.sqrt() + (STANDSTILL_M * ratio + closed_m) / speed_mps.max(f64::MIN_POSITIVE)
}

/// The ends of lanes at which the vehicle must stand once, and has not passed \[m\].
pub(crate) fn signed_lines(agent: &Agent) -> Vec<f64> {
    let front_m = front_m(agent);
    let signed = |sign: RightOfWay| matches!(sign, RightOfWay::Stop | RightOfWay::AllWayStop);
    let legs = agent.route.legs.iter().filter(|leg| signed(leg.right_of_way) && leg.to_m >= front_m);
    legs.map(|leg| leg.to_m).collect()
}

/// Where the front of a vehicle is on its route \[m\].
pub(crate) fn front_m(agent: &Agent) -> f64 {
    agent.along_m() + agent.body.front_m
}

pub(crate) fn length_m(agent: &Agent) -> f64 {
    agent.body.front_m + agent.body.rear_m
}

/// The length of a car of the scale of a vehicle, by which distances to lines are measured whatever the vehicle \[m\].
pub(crate) fn car_length_m(agent: &Agent) -> f64 {
    CAR_LENGTH_M * agent.body.scale
}

/// How far before a line a vehicle stops \[m\].
pub(crate) fn stopping_distance_m(agent: &Agent) -> f64 {
    STOPPING_LENGTHS * car_length_m(agent)
}

/// Whether a vehicle can stop before a place.
pub(crate) fn can_stop(agent: &Agent, place_m: f64) -> bool {
    let speed_mps = agent.state.speed_mps;
    let braking_m = speed_mps * speed_mps / (2.0 * BRAKING_SHARE * agent.limits.acceleration_min_mps2.abs());
    // A vehicle that stands a little beyond still waits.
    front_m(agent) + braking_m <= place_m + STOPPING_LENGTHS * car_length_m(agent)
}

/// The time for a way from a speed on, with a constant acceleration up to a wanted speed \[s\].
pub(crate) fn time_s(way_m: f64, speed_mps: f64, wanted_mps: f64, acceleration_mps2: f64) -> f64 {
    let most_mps = wanted_mps.max(speed_mps);
    let until_s = (most_mps - speed_mps) / acceleration_mps2;
    let until_m = 0.5 * (speed_mps + most_mps) * until_s;
    if way_m <= until_m {
        let root = (speed_mps * speed_mps + 2.0 * acceleration_mps2 * way_m.max(0.0)).sqrt();
        return (root - speed_mps) / acceleration_mps2;
    }
    if most_mps > 0.0 { until_s + (way_m - until_m) / most_mps } else { f64::INFINITY }
}
