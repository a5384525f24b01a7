//! When to change lanes: MOBIL (Kesting, Treiber and Helbing, 2007).
//!
//! A change pays and is safe if
//!
//! ```text
//! ã_c − a_c + p ((ã_n − a_n) + (ã_o − a_o)) ± bias > threshold,    ã_n > −b_safe,  ã_c > −b_safe
//! ```
//!
//! where `c` is the vehicle itself, `n` the follower it would get, `o` the one it has, and a tilde means "after the change".
//! The bias favours the goal's lane: it is positive for lanes nearer to it and negative for others. What others want is not
//! known: they are taken to be content with their present speeds.

use super::Settings;
use crate::drivers::lanes::Leader;
use crate::drivers::lanes::{RoadLanes, at, follower, is_in, leader};
use crate::scene::relation::is_standing;
use crate::{Agent, Scene};

/// A lane and by how much it is better than staying, threshold included; negative for staying.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LaneChoice {
    pub lane: usize,
    pub incentive_mps2: f64,
}

/// A vehicle that comes into the lane beside within this time is looked at, of real vehicles \[s\],
const LOOK_AHEAD_S: f64 = 3.0;
/// and it is beside the own one up to this gap between bumpers, of real vehicles \[m\].
const BESIDE_GAP_M: f64 = 2.0;
/// Of the way to the other lane, a vehicle turns back from a change up to this share of the width of a lane.
const TURNING_BACK: f64 = 0.3;

/// The lane to drive in: `now`, or a neighbour that pays. A change under way is finished first, unless the lane is taken at its begin.
/// Beside itself it looks at all `others`, those too whose ways only join its own.
pub(super) fn choose(scene: &Scene, others: &[Agent], settings: &Settings, now: usize) -> LaneChoice {
    let (mobil, lanes) = (&settings.mobil, RoadLanes::of_road(scene, settings.mobil.lane_width_m));
    let off_centre = scene.ego.route.across(scene.ego.state.position()) - lanes.centre_m(now);
    let goal = lanes.at(scene.ego.route.across(scene.goal.target.position()));
    let mut best = LaneChoice { lane: now, incentive_mps2: f64::NEG_INFINITY };
    if off_centre.abs() > 0.25 * lanes.width_m() {
        let here_m = scene.ego.route.across(scene.ego.state.position());
        let nearest = lanes.at(here_m);
        let may_turn_back = (here_m - lanes.centre_m(nearest)).abs() < TURNING_BACK * lanes.width_m();
        if nearest != now && may_turn_back && is_taken(scene, others, &lanes, now) {
            return LaneChoice { lane: nearest, incentive_mps2: 0.0 };
        }
        return LaneChoice { incentive_mps2: 0.0, ..best };
    }
    let beside = [now.checked_sub(1), Some(now + 1).filter(|lane| *lane < lanes.count())].into_iter().flatten();
    // A driver does not change to a lane that it will have to leave again.
    for lane in beside.filter(|lane| lanes.end_m(*lane).is_none()) {
        let nearer = if lane.abs_diff(goal) < now.abs_diff(goal) { 1.0 } else { -1.0 };
        if is_taken(scene, others, &lanes, lane) {
            continue;
        }
        let change = Change { scene, settings, lanes, now, lane };
        let advantage = change.advantage() + nearer * mobil.bias_mps2 - mobil.threshold_mps2;
        let incentive_mps2 = if change.is_safe() { advantage } else { -mobil.threshold_mps2 };
        if incentive_mps2 > best.incentive_mps2 {
            best = LaneChoice { lane: if incentive_mps2 > 0.0 { lane } else { now }, incentive_mps2 };
        }
    }
    best
}

/// Whether a vehicle is expected in a lane right beside the own one, which keeps its speed. Only a driver that sees motion expects it.
fn is_taken(scene: &Scene, others: &[Agent], lanes: &RoadLanes, lane: usize) -> bool {
    let Scene { ego, knowledge, step_s, .. } = scene;
    let ratio = ego.body.real_ratio();
    let steps = (LOOK_AHEAD_S * ratio.sqrt() / step_s).ceil() as usize;
    let (own_m, reach_m) = (ego.route.along(ego.state.position()), BESIDE_GAP_M * ratio);
    let comes = |other: &Agent| {
        (0..=steps).any(|t| {
            let there = ego.route.locate(at(other, t).position(), None);
            let lead_m = there.along_m - own_m - ego.state.speed_mps * step_s * t as f64;
            let beside_m = if lead_m > 0.0 {
                lead_m - ego.body.front_m - other.body.rear_m
            } else {
                -lead_m - ego.body.rear_m - other.body.front_m
            };
            beside_m < reach_m && is_in(scene, lanes, lane, other, t)
        })
    };
    knowledge.is_of_motion() && others.iter().any(|other| !other.is_obstacle && comes(other))
}

/// A change of lane in question.
#[derive(Clone, Copy)]
struct Change<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    lanes: RoadLanes,
    now: usize,
    lane: usize,
}

impl Change<'_> {
    /// The ego's acceleration in a lane.
    fn own(&self, lane: usize) -> f64 {
        let (state, wanted) = (&self.scene.ego.state, self.scene.goal.target.speed_mps);
        self.settings.acceleration(state.speed_mps, wanted, leader(self.scene, &self.lanes, lane, state, 0))
    }

    /// A follower's acceleration behind a leader.
    fn follower(&self, follower: &Agent, ahead: Option<Leader>) -> f64 {
        let speed = follower.state.speed_mps;
        self.settings.acceleration(speed, speed, ahead)
    }

    /// What stands before a follower of a lane if the ego is in that lane, and if it is not.
    fn ahead_of(&self, follower: &Agent, lane: usize) -> [Option<Leader>; 2] {
        let road = &self.scene.ego.route;
        let front = road.along(follower.state.position()) + follower.body.front_m;
        let ego = &self.scene.ego;
        let behind_ego = Leader {
            gap_m: road.along(ego.state.position()) - ego.body.rear_m - front,
            speed_mps: ego.state.speed_mps,
        };
        // The ego's leader in the lane is the follower's without the ego.
        let shift = road.along(ego.state.position()) + ego.body.front_m - front;
        let without = leader(self.scene, &self.lanes, lane, &ego.state, 0);
        [Some(behind_ego), without.map(|leader| Leader { gap_m: leader.gap_m + shift, ..leader })]
    }

    /// `ã_c − a_c + p ((ã_n − a_n) + (ã_o − a_o))`.
    fn advantage(&self) -> f64 {
        let mut others = 0.0;
        if let Some(new) = follower(self.scene, &self.lanes, self.lane) {
            let [with, without] = self.ahead_of(new, self.lane).map(|ahead| self.follower(new, ahead));
            others += with - without;
        }
        if let Some(old) = follower(self.scene, &self.lanes, self.now) {
            let [with, without] = self.ahead_of(old, self.now).map(|ahead| self.follower(old, ahead));
            others += without - with;
        }
        self.own(self.lane) - self.own(self.now) + self.settings.mobil.politeness * others
    }

    fn is_safe(&self) -> bool {
        let hardest = -self.settings.mobil.safe_braking_mps2;
        let new = follower(self.scene, &self.lanes, self.lane);
        let forced = new.map(|new| self.follower(new, self.ahead_of(new, self.lane)[0]));
        let is_gentle = forced.is_none_or(|acceleration| acceleration > hardest) && self.own(self.lane) > hardest;
        is_gentle && self.has_room_to_swing_out()
    }

    /// Whether a driver that sees motion only comes past what stands ahead in its lane.
    fn has_room_to_swing_out(&self) -> bool {
        let Scene { ego, others, knowledge, .. } = self.scene;
        let standing = ego.leader_among(others).filter(|leader| knowledge.is_of_motion() && is_standing(leader));
        standing.is_none_or(|leader| {
            let room_m = ego.lead_of(leader) - leader.body.rear_m - ego.body.front_m;
            let beside_m = 0.5 * (ego.body.width_m + leader.body.width_m);
            let apart_m = ego.route.across(leader.state.position()) - ego.route.across(ego.state.position());
            !ego.is_too_near_to_swing_out(room_m, beside_m - apart_m.abs())
        })
    }
}
