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
use crate::drivers::lanes::{Leader, RoadLanes, at, follower, is_in, leader};
use crate::scene::relation::is_standing;
use crate::{Agent, Scene};

/// A lane and by how much it is better than staying, threshold included; negative for staying.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LaneChoice {
    pub lane: usize,
    pub incentive_mps2: f64,
}

/// A vehicle that comes into the lane beside within this time is looked at, of real vehicles \[s\],
pub(super) const LOOK_AHEAD_S: f64 = 3.0;
/// and it is beside the own one up to this gap between bumpers, of real vehicles \[m\].
pub(super) const BESIDE_GAP_M: f64 = 2.0;
/// Of the way to the other lane, a vehicle turns back from a change up to this share of the width of a lane.
const TURNING_BACK: f64 = 0.3;

/// What a vehicle sees of the lanes of its road.
pub(super) trait SeenLanes {
    /// What is ahead in a lane, and who is behind.
    fn seen(&self, lane: usize) -> LaneTraffic;

    /// Whether a vehicle is expected in a lane with this traffic right beside the own one, which keeps its speed.
    fn is_taken(&self, lane: usize, traffic: &LaneTraffic) -> bool;

    /// Whether there is room to leave the own lane.
    fn has_room(&self) -> bool;
}

/// What a vehicle sees of a lane: what is ahead in it, and who is behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LaneTraffic {
    pub ahead: Option<Leader>,
    pub behind: Option<Follower>,
}

/// The vehicle behind in a lane: where its front is along the road \[m\], and its speed \[m/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Follower {
    pub front_m: f64,
    pub speed_mps: f64,
}

/// A vehicle that may change the lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Changing {
    /// The arc length of its mass centre, and its front and rear from there \[m\].
    pub along_m: f64,
    pub front_m: f64,
    pub rear_m: f64,
    /// Lateral coordinates of itself and of its goal \[m\].
    pub across_m: f64,
    pub goal_across_m: f64,
    pub speed_mps: f64,
    pub wanted_mps: f64,
}

impl Changing {
    /// The planning vehicle of a scene.
    pub fn of(scene: &Scene) -> Changing {
        let Scene { ego, goal, .. } = scene;
        let place = ego.place();
        Changing {
            along_m: place.along_m,
            front_m: ego.body.front_m,
            rear_m: ego.body.rear_m,
            across_m: place.across_m,
            goal_across_m: ego.route.across(goal.target.position()),
            speed_mps: ego.state.speed_mps,
            wanted_mps: goal.target.speed_mps,
        }
    }
}

/// The lanes as the planning vehicle of a scene sees them. Beside itself it looks at all `others`, those too whose ways only join its own.
pub(super) struct LanesOfScene<'a> {
    pub scene: &'a Scene,
    pub others: &'a [Agent],
    pub lanes: &'a RoadLanes,
}

impl SeenLanes for LanesOfScene<'_> {
    fn seen(&self, lane: usize) -> LaneTraffic {
        let Scene { ego, .. } = self.scene;
        let behind = follower(self.scene, self.lanes, lane).map(|behind| Follower {
            front_m: ego.route.along(behind.state.position()) + behind.body.front_m,
            speed_mps: behind.state.speed_mps,
        });
        LaneTraffic { ahead: leader(self.scene, self.lanes, lane, &ego.state, 0), behind }
    }

    /// Only a driver that sees motion expects it.
    fn is_taken(&self, lane: usize, _: &LaneTraffic) -> bool {
        let Scene { ego, knowledge, step_s, .. } = self.scene;
        let ratio = ego.body.real_ratio();
        let steps = (LOOK_AHEAD_S * ratio.sqrt() / step_s).ceil() as usize;
        let (own_m, reach_m) = (ego.along_m(), BESIDE_GAP_M * ratio);
        let comes = |other: &Agent| {
            (0..=steps).any(|t| {
                let there = ego.route.locate(at(other, t).position(), None);
                let lead_m = there.along_m - own_m - ego.state.speed_mps * step_s * t as f64;
                let beside_m = if lead_m > 0.0 {
                    lead_m - ego.body.front_m - other.body.rear_m
                } else {
                    -lead_m - ego.body.rear_m - other.body.front_m
                };
                beside_m < reach_m && is_in(self.scene, self.lanes, lane, other, t)
            })
        };
        knowledge.is_of_motion() && self.others.iter().any(|other| !other.is_obstacle && comes(other))
    }

    fn has_room(&self) -> bool {
        has_room_to_swing_out(self.scene)
    }
}

/// The lane to drive in: `now`, or a neighbour that pays. A change under way is finished first, unless the lane is taken at its begin.
pub(super) fn choose(
    own: &Changing,
    settings: &Settings,
    lanes: &RoadLanes,
    now: usize,
    seen: &impl SeenLanes,
) -> LaneChoice {
    let mobil = &settings.mobil;
    let off_centre = own.across_m - lanes.centre_m(now);
    let goal = lanes.at(own.goal_across_m);
    let mut best = LaneChoice { lane: now, incentive_mps2: f64::NEG_INFINITY };
    if off_centre.abs() > 0.25 * lanes.width_m() {
        let nearest = lanes.at(own.across_m);
        let may_turn_back = (own.across_m - lanes.centre_m(nearest)).abs() < TURNING_BACK * lanes.width_m();
        if nearest != now && may_turn_back && seen.is_taken(now, &seen.seen(now)) {
            return LaneChoice { lane: nearest, incentive_mps2: 0.0 };
        }
        return LaneChoice { incentive_mps2: 0.0, ..best };
    }
    let beside = [now.checked_sub(1), Some(now + 1).filter(|lane| *lane < lanes.count())].into_iter().flatten();
    let mut here = None;
    let free = settings.free(own.speed_mps, own.wanted_mps);
    // A driver does not change to a lane that it will have to leave again.
    for lane in beside.filter(|lane| lanes.end_m(*lane).is_none()) {
        let nearer = if lane.abs_diff(goal) < now.abs_diff(goal) { 1.0 } else { -1.0 };
        let there = seen.seen(lane);
        if seen.is_taken(lane, &there) {
            continue;
        }
        let here = *here.get_or_insert_with(|| seen.seen(now));
        let change = Change { own, settings, free, here, there };
        let advantage = change.advantage() + nearer * mobil.bias_mps2 - mobil.threshold_mps2;
        let incentive_mps2 = if change.is_gentle() && seen.has_room() { advantage } else { -mobil.threshold_mps2 };
        if incentive_mps2 > best.incentive_mps2 {
            best = LaneChoice { lane: if incentive_mps2 > 0.0 { lane } else { now }, incentive_mps2 };
        }
    }
    best
}

/// A change of lane in question.
#[derive(Clone, Copy)]
struct Change<'a> {
    own: &'a Changing,
    settings: &'a Settings,
    /// [`Settings::free`] of its own speeds.
    free: f64,
    here: LaneTraffic,
    there: LaneTraffic,
}

impl Change<'_> {
    /// Its own acceleration in a lane.
    fn own(&self, lane: LaneTraffic) -> f64 {
        self.settings.acceleration_with(self.free, self.own.speed_mps, lane.ahead)
    }

    /// A follower's acceleration behind a leader.
    fn follower(&self, follower: Follower, ahead: Option<Leader>) -> f64 {
        self.settings.acceleration(follower.speed_mps, follower.speed_mps, ahead)
    }

    /// What stands before the follower of a lane if the vehicle is in that lane, and if it is not.
    fn ahead_of(&self, follower: Follower, lane: LaneTraffic) -> [Option<Leader>; 2] {
        let Changing { along_m, front_m, rear_m, speed_mps, .. } = *self.own;
        let behind_own = Leader { gap_m: along_m - rear_m - follower.front_m, speed_mps };
        // Its leader in the lane is the follower's without it.
        let shift = along_m + front_m - follower.front_m;
        [Some(behind_own), lane.ahead.map(|leader| Leader { gap_m: leader.gap_m + shift, ..leader })]
    }

    /// `ã_c − a_c + p ((ã_n − a_n) + (ã_o − a_o))`.
    fn advantage(&self) -> f64 {
        let mut others = 0.0;
        if let Some(new) = self.there.behind {
            let [with, without] = self.ahead_of(new, self.there).map(|ahead| self.follower(new, ahead));
            others += with - without;
        }
        if let Some(old) = self.here.behind {
            let [with, without] = self.ahead_of(old, self.here).map(|ahead| self.follower(old, ahead));
            others += without - with;
        }
        self.own(self.there) - self.own(self.here) + self.settings.mobil.politeness * others
    }

    fn is_gentle(&self) -> bool {
        let hardest = -self.settings.mobil.safe_braking_mps2;
        let forced = self.there.behind.map(|new| self.follower(new, self.ahead_of(new, self.there)[0]));
        forced.is_none_or(|acceleration| acceleration > hardest) && self.own(self.there) > hardest
    }
}

/// Whether a driver that sees motion only comes past what stands ahead in its lane.
fn has_room_to_swing_out(scene: &Scene) -> bool {
    let Scene { ego, others, knowledge, .. } = scene;
    let standing = ego.leader_among(others).filter(|leader| knowledge.is_of_motion() && is_standing(leader));
    standing.is_none_or(|leader| {
        let room_m = ego.lead_of(leader) - leader.body.rear_m - ego.body.front_m;
        let beside_m = 0.5 * (ego.body.width_m + leader.body.width_m);
        let apart_m = ego.route.across(leader.state.position()) - ego.across_m();
        !ego.is_too_near_to_swing_out(room_m, beside_m - apart_m.abs())
    })
}
