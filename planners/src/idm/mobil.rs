//! When to change lanes: MOBIL (Kesting, Treiber and Helbing, 2007).
//!
//! A change pays and is safe if
//!
//! ```text
//! ã_c − a_c + p ((ã_n − a_n) + (ã_o − a_o)) ± bias > threshold,    ã_n > −b_safe,  ã_c > −b_safe
//! ```
//!
//! where `c` is the vehicle itself, `n` the follower it would get, `o` the one it has, and a tilde means "after the change".
//! The bias is the wish for the goal's lane: it speaks for lanes nearer to it and against others. What others want is not
//! known: they are taken to be content with their present speeds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::idm::{self, Leader};
use crate::{Agent, Scene, State};

/// When to change lanes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Mobil {
    /// Width of the lanes, which are counted from the right edge of the road \[m\].
    #[schemars(range(min = 0.001))]
    pub lane_width_m: f64,
    /// What others' accelerations count against the own, `p`.
    #[schemars(range(min = 0.0))]
    pub politeness: f64,
    /// Least advantage that a change must bring \[m/s²\].
    #[schemars(range(min = 0.0))]
    pub threshold_mps2: f64,
    /// How hard the new follower, or the vehicle itself, may have to brake, `b_safe`, positive \[m/s²\].
    #[schemars(range(min = 0.0))]
    pub safe_braking_mps2: f64,
    /// The wish for the lane of the goal \[m/s²\].
    #[schemars(range(min = 0.0))]
    pub bias_mps2: f64,
}

impl Default for Mobil {
    fn default() -> Self {
        Mobil { lane_width_m: 0.37, politeness: 0.2, threshold_mps2: 0.05, safe_braking_mps2: 0.6, bias_mps2: 1.0 }
    }
}

/// The lanes of a road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lanes {
    right_m: f64,
    width_m: f64,
    count: usize,
}

impl Lanes {
    /// The lane in which a lateral position lies; beside the road, the nearest.
    pub(super) fn at(&self, lateral_m: f64) -> usize {
        let lane = ((lateral_m - self.right_m) / self.width_m).floor().max(0.0) as usize;
        lane.min(self.count - 1)
    }

    /// The lateral position of a lane's centre \[m\].
    pub(super) fn centre_m(&self, lane: usize) -> f64 {
        self.right_m + (lane as f64 + 0.5) * self.width_m
    }
}

impl Mobil {
    /// The lanes of the ego's road; at least one.
    pub(super) fn lanes(&self, scene: &Scene) -> Lanes {
        let road = &scene.ego.corridor;
        let count = ((road.left_m - road.right_m) / self.lane_width_m).round().max(1.0) as usize;
        Lanes { right_m: road.right_m, width_m: self.lane_width_m, count }
    }
}

/// A lane and by how much it is better than staying, threshold included; negative for staying.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    pub lane: usize,
    pub incentive_mps2: f64,
}

/// The lane to drive in: `now`, or a neighbour that pays. A change under way is finished first.
pub(super) fn choose(scene: &Scene, settings: &idm::Settings, now: usize) -> Choice {
    let (mobil, lanes) = (&settings.mobil, settings.mobil.lanes(scene));
    let off_centre = scene.ego.corridor.across(scene.ego.state.position()) - lanes.centre_m(now);
    let goal = lanes.at(scene.ego.corridor.across(scene.goal.target.position()));
    let mut best = Choice { lane: now, incentive_mps2: f64::NEG_INFINITY };
    if off_centre.abs() > 0.25 * lanes.width_m {
        return Choice { incentive_mps2: 0.0, ..best };
    }
    for lane in [now.checked_sub(1), Some(now + 1).filter(|lane| *lane < lanes.count)].into_iter().flatten() {
        let nearer = if lane.abs_diff(goal) < now.abs_diff(goal) { 1.0 } else { -1.0 };
        let change = Change { scene, settings, lanes, now, lane };
        let advantage = change.advantage() + nearer * mobil.bias_mps2 - mobil.threshold_mps2;
        let incentive_mps2 = if change.is_safe() { advantage } else { -mobil.threshold_mps2 };
        if incentive_mps2 > best.incentive_mps2 {
            best = Choice { lane: if incentive_mps2 > 0.0 { lane } else { now }, incentive_mps2 };
        }
    }
    best
}

/// A change of lane in question.
#[derive(Clone, Copy)]
struct Change<'a> {
    scene: &'a Scene,
    settings: &'a idm::Settings,
    lanes: Lanes,
    now: usize,
    lane: usize,
}

impl Change<'_> {
    /// The ego's acceleration in a lane.
    fn own(&self, lane: usize) -> f64 {
        let (state, wanted) = (&self.scene.ego.state, self.scene.goal.target.speed_mps);
        self.settings.acceleration(state.speed_mps, wanted, leader(self.scene, &self.lanes, lane, state, 0))
    }

    /// A follower's acceleration behind somebody.
    fn follower(&self, follower: &Agent, ahead: Option<Leader>) -> f64 {
        let speed = follower.state.speed_mps;
        self.settings.acceleration(speed, speed, ahead)
    }

    /// What stands before a follower of a lane if the ego is in that lane, and if it is not.
    fn ahead_of(&self, follower: &Agent, lane: usize) -> [Option<Leader>; 2] {
        let road = &self.scene.ego.corridor;
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
        forced.is_none_or(|acceleration| acceleration > hardest) && self.own(self.lane) > hardest
    }
}

/// Whether a vehicle is at least partly in a lane of the ego's road at time `t` of its prediction.
fn is_in(scene: &Scene, lanes: &Lanes, lane: usize, other: &Agent, t: usize) -> bool {
    let lateral = scene.ego.corridor.across(at(other, t).position());
    let reach = 0.5 * (lanes.width_m + other.body.width_m);
    !scene.ego.crosses(other) && (lateral - lanes.centre_m(lane)).abs() < reach
}

/// Where a vehicle is at time `t` of its prediction.
fn at(other: &Agent, t: usize) -> State {
    other.prediction.states.get(t).or(other.prediction.states.last()).copied().unwrap_or(other.state)
}

/// What is ahead of a state in a lane at time `t`: the nearest vehicle, or the lane's end.
pub(super) fn leader(scene: &Scene, lanes: &Lanes, lane: usize, state: &State, t: usize) -> Option<Leader> {
    let (ego, road) = (&scene.ego, &scene.ego.corridor);
    let own = road.along(state.position());
    let vehicles = scene.others.iter().filter(|other| is_in(scene, lanes, lane, other, t)).filter_map(|other| {
        let there = at(other, t);
        let ahead = road.along(there.position()) - own;
        let gap_m = ahead - other.body.rear_m - ego.body.front_m;
        (ahead > 0.0).then_some(Leader { gap_m, speed_mps: there.speed_mps })
    });
    // Three length scales of its taper before the end there is no room left.
    let end = road
        .end
        .filter(|_| lane == 0)
        .map(|end| Leader { gap_m: end.end_m - 3.0 * end.taper_m - own - ego.body.front_m, speed_mps: 0.0 });
    vehicles.chain(end).min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
}

/// The nearest vehicle behind the ego in a lane, now.
fn follower<'a>(scene: &'a Scene, lanes: &Lanes, lane: usize) -> Option<&'a Agent> {
    let behind = |other: &&Agent| scene.ego.lead_of(other) <= 0.0 && is_in(scene, lanes, lane, other, 0);
    let behind = scene.others.iter().filter(behind);
    behind.max_by(|a, b| scene.ego.lead_of(a).total_cmp(&scene.ego.lead_of(b)))
}
