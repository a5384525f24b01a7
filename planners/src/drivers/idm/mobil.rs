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
use crate::Scene;
use crate::drivers::lanes::{Leader, RoadLanes, follower, leader};
use crate::scene::relation::is_standing;

/// A lane and by how much it is better than staying, threshold included; negative for staying.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LaneChoice {
    pub lane: usize,
    pub incentive_mps2: f64,
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
        let position = ego.state.position();
        Changing {
            along_m: ego.route.along(position),
            front_m: ego.body.front_m,
            rear_m: ego.body.rear_m,
            across_m: ego.route.across(position),
            goal_across_m: ego.route.across(goal.target.position()),
            speed_mps: ego.state.speed_mps,
            wanted_mps: goal.target.speed_mps,
        }
    }
}

/// The lane of a scene to drive in: `now`, or a neighbour that pays. A change under way is finished first.
pub(super) fn choose(scene: &Scene, settings: &Settings, lanes: &RoadLanes, now: usize) -> LaneChoice {
    let own = Changing::of(scene);
    let seen = |lane: usize| LaneTraffic {
        ahead: leader(scene, lanes, lane, &scene.ego.state, 0),
        behind: follower(scene, lanes, lane).map(|behind| Follower {
            front_m: scene.ego.route.along(behind.state.position()) + behind.body.front_m,
            speed_mps: behind.state.speed_mps,
        }),
    };
    choose_among(&own, settings, lanes, now, seen, || has_room_to_swing_out(scene))
}

/// The same of a vehicle with what it sees of each lane, and whether it has room to leave its own.
pub(super) fn choose_among(
    own: &Changing,
    settings: &Settings,
    lanes: &RoadLanes,
    now: usize,
    seen: impl Fn(usize) -> LaneTraffic,
    has_room: impl Fn() -> bool,
) -> LaneChoice {
    let mobil = &settings.mobil;
    let off_centre = own.across_m - lanes.centre_m(now);
    let goal = lanes.at(own.goal_across_m);
    let mut best = LaneChoice { lane: now, incentive_mps2: f64::NEG_INFINITY };
    if off_centre.abs() > 0.25 * lanes.width_m() {
        return LaneChoice { incentive_mps2: 0.0, ..best };
    }
    let beside = [now.checked_sub(1), Some(now + 1).filter(|lane| *lane < lanes.count())].into_iter().flatten();
    let mut here = None;
    // A driver does not change to a lane that it will have to leave again.
    for lane in beside.filter(|lane| lanes.end_m(*lane).is_none()) {
        let nearer = if lane.abs_diff(goal) < now.abs_diff(goal) { 1.0 } else { -1.0 };
        let here = *here.get_or_insert_with(|| seen(now));
        let change = Change { own, settings, here, there: seen(lane) };
        let advantage = change.advantage() + nearer * mobil.bias_mps2 - mobil.threshold_mps2;
        let incentive_mps2 = if change.is_gentle() && has_room() { advantage } else { -mobil.threshold_mps2 };
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
    here: LaneTraffic,
    there: LaneTraffic,
}

impl Change<'_> {
    /// Its own acceleration in a lane.
    fn own(&self, lane: LaneTraffic) -> f64 {
        self.settings.acceleration(self.own.speed_mps, self.own.wanted_mps, lane.ahead)
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
