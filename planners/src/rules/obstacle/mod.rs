//! What stands in the way: whether it is passed, where, and which vehicle a driver waits for before.
//!
//! A vehicle that stands in a driver's lane is one of two things. It waits in a queue (`rules::queue`): then it is
//! followed. Or it is an obstacle: then it is passed, beside its body, on a part of the road that may belong to others. That is done only
//! while no other vehicle comes to that part before the driver is back in its lane ([`room`]); until then the driver waits behind. The
//! condition is hard, whatever the driver's style, and is checked again at each tick: a driver who is not beside the obstacle yet goes
//! back behind it.

mod room;
mod standing;

pub(crate) use standing::swing_m;

use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::rules::queue;
use crate::scene::relation::is_standing;
use crate::scene::road_rules::Obstacle;
use crate::{Agent, Scene};

/// A vehicle in the way reaches within this distance of the path, for 1/10 scale cars \[m\].
const NEAR_PATH_M: f64 = 0.02;
/// Further than this from its lateral goal a 1/10 scale car is out of its lane \[m\].
const OUT_OF_LANE_M: f64 = 0.08;
/// An obstacle is looked for as far ahead as a driver comes in this time at the speed that it wants, for 1/10 scale cars \[s\].
const LOOK_AHEAD_S: f64 = 2.5;
/// A vehicle with another one ahead within this many lengths of a car stands in a queue.
const QUEUE_LENGTHS: f64 = 2.5;

/// A vehicle that waited is given this time to start when its reason has ended, for 1/10 scale cars \[s\]: 3 s of a real one.
const STARTS_S: f64 = 0.95;

/// What a driver does about an obstacle.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Manoeuvre {
    /// There is room: it passes.
    Pass(Obstacle),
    /// It waits behind, for a vehicle if there is one, or since the road is too narrow.
    Wait(Obstacle, Option<String>),
}

impl Manoeuvre {
    /// The obstacle, and whether it is passed; if it is not, the planning vehicle of `scene` has to stay behind it.
    pub(crate) fn laid_over(self, scene: &mut Cow<'_, Scene>) -> (Obstacle, bool) {
        match self {
            Manoeuvre::Pass(obstacle) => (obstacle, true),
            Manoeuvre::Wait(obstacle, _) => {
                let line_m = obstacle.line_m(scene);
                scene.to_mut().ego.rules.stop_before(line_m);
                (obstacle, false)
            }
        }
    }
}

/// A manoeuvre that has begun.
#[derive(Clone, Debug, PartialEq)]
struct Passing {
    /// The nearest obstacle of the row.
    name: String,
    /// Where the row ends that there was room to pass, along the driver's route \[m\].
    until_m: f64,
}

/// What a driver remembers of stationary vehicles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ObstacleMemory {
    /// Since which tick each has been standing; 0 if it stood when it was first seen.
    standing_since: BTreeMap<String, usize>,
    /// The last tick at which each stood and waited for a visible reason.
    waited_at: BTreeMap<String, usize>,
    /// Who is being passed.
    passing: Option<Passing>,
}

impl ObstacleMemory {
    /// The name of what is being passed.
    pub(crate) fn passing(&self) -> Option<&str> {
        self.passing.as_ref().map(|passing| &*passing.name)
    }

    /// What to do about the nearest obstacle on the way; none without one. To be called once a tick.
    pub(crate) fn judge(&mut self, scene: &Scene) -> Option<Manoeuvre> {
        self.note(scene);
        let found = self.nearest(scene);
        let Some(obstacle) = found else {
            self.passing = None;
            return None;
        };
        let out_m = scene.ego.across_m() - scene.ego.route.across(scene.goal.target.position());
        let is_out = out_m.abs() > OUT_OF_LANE_M * scene.ego.body.scale;
        // A driver that has begun to pass a row goes on to its next vehicle. Nor does it come back when a slow vehicle that it overtakes
        // stops.
        let is_under_way = self.passing.as_ref().is_some_and(|passing| obstacle.along_m[0] < passing.until_m)
            || is_out && obstacle.is_beyond_braking(scene);
        let Some(obstacle) = obstacle.with_side(scene) else {
            // A vehicle without room beside it is followed, however long it stands.
            let is_followed = scene.knowledge.is_of_motion() && !obstacle.is_without_driver;
            return (!is_followed).then_some(Manoeuvre::Wait(obstacle, None));
        };
        if !is_under_way && obstacle.is_too_near_to_swing_out(scene) {
            self.passing = None;
            return Some(Manoeuvre::Wait(obstacle, None));
        }
        let obstacle = room::with_row(scene, obstacle);
        let until_m = obstacle.row_end_m;
        match room::in_the_way(scene, &obstacle, until_m, is_under_way) {
            None => {
                self.passing = Some(Passing { name: obstacle.name.clone(), until_m });
                Some(Manoeuvre::Pass(obstacle))
            }
            Some(other) => {
                self.passing = None;
                Some(Manoeuvre::Wait(obstacle, Some(other.name.clone())))
            }
        }
    }

    fn note(&mut self, scene: &Scene) {
        let is_first = self.standing_since.is_empty() && scene.tick == 0;
        for other in &scene.others {
            if is_standing(other) {
                let since = if is_first { 0 } else { scene.tick };
                self.standing_since.entry(other.name.clone()).or_insert(since);
                if queue::waits(other, scene.others.iter()) {
                    self.waited_at.insert(other.name.clone(), scene.tick);
                }
            } else {
                self.standing_since.remove(&other.name);
            }
        }
    }

    /// The nearest obstacle whose end is not passed yet.
    fn nearest(&self, scene: &Scene) -> Option<Obstacle> {
        let ego = &scene.ego;
        let (own_m, wanted_mps) = (ego.along_m(), scene.goal.target.speed_mps);
        let reach_m = LOOK_AHEAD_S * ego.body.time_ratio() * wanted_mps.max(ego.state.speed_mps) + ego.body.front_m;
        let goal_m = ego.route.across(scene.goal.target.position());
        let here_m = ego.across_m();
        // Straight roads have no lanes that belong to others: of what stands there, only what has no driver is passed by these rules.
        let counts = |other: &&Agent| other.is_obstacle || ego.route.is_in_network();
        let standing = scene.others.iter().filter(counts).filter(|other| is_standing(other));
        let candidates = standing.filter(|other| !self.is_queueing(scene, other));
        let obstacles = candidates.filter_map(|other| {
            let at = ego.route.locate(other.state.position(), None);
            let [half_length_m, half_width_m] = other.half_extents_m(at.heading_rad);
            let reach =
                [0.5 * (ego.body.front_m + ego.body.rear_m) + half_length_m, 0.5 * ego.body.width_m + half_width_m];
            let blocks = |lateral_m: f64| (at.across_m - lateral_m).abs() < reach[1] + NEAR_PATH_M * ego.body.scale;
            let along_m = if other.is_obstacle {
                [at.along_m - half_length_m, at.along_m + half_length_m]
            } else {
                [at.along_m - other.body.rear_m, at.along_m + other.body.front_m]
            };
            let is_ahead = along_m[1] > own_m - ego.body.rear_m && along_m[0] < own_m + reach_m;
            let found = Obstacle {
                name: other.name.clone(),
                along_m,
                across_m: at.across_m,
                pass_at_m: at.across_m,
                row_end_m: along_m[1],
                reach_m: reach,
                is_without_driver: other.is_obstacle,
            };
            (is_ahead && (blocks(goal_m) || (blocks(here_m) && at.along_m > own_m))).then_some(found)
        });
        obstacles.min_by(|a, b| a.along_m[0].total_cmp(&b.along_m[0]))
    }

    /// Whether a vehicle that stands waits in a queue: for a visible reason that may just have ended, or since it came to a stop close
    /// behind another one.
    fn is_queueing(&self, scene: &Scene, other: &Agent) -> bool {
        if other.is_obstacle {
            return false;
        }
        let starts_s = if scene.knowledge.is_of_motion() { STARTS_S * scene.ego.body.time_ratio() } else { 0.0 };
        let reason_ended_s = |tick: &usize| (scene.tick - tick) as f64 * scene.step_s;
        if self.waited_at.get(&other.name).map(reason_ended_s).is_some_and(|ended_s| ended_s <= starts_s) {
            return true;
        }
        let has_come = self.standing_since.get(&other.name).is_none_or(|since| *since > 0);
        let length_m = scene.ego.body.front_m + scene.ego.body.rear_m;
        let is_next = |third: &Agent| {
            let lead_m = other.lead_of(third);
            other.shares_lane_with(third) && lead_m > 0.0 && lead_m < (QUEUE_LENGTHS + 1.0) * length_m
        };
        has_come && scene.others.iter().filter(|third| third.name != other.name).any(is_next)
    }
}
