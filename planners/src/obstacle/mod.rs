//! What stands in the way: whether it is passed, where, and for whom a driver waits before.
//!
//! A vehicle that stands in a driver's lane is one of three things. It waits in a queue, at a line or behind somebody: then it is
//! followed. Or it is an obstacle: then it is passed, beside its body, on a part of the road that may belong to somebody else. That is
//! done only while nobody else comes to that part before the driver is back in its lane ([`room`]); until then the driver waits behind.
//! The condition is hard, whatever the driver's style, and is checked again at each tick: a driver who is not beside the obstacle yet
//! goes back behind it.

mod room;

use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::certificate::touches_ahead;
use crate::posing::ellipses;
use crate::rules::is_standing;
use crate::steering::{admissible, roll_out, steer};
use crate::trajectory::Penalty;
use crate::trajectory::terms::KeepOut;
use crate::{Agent, Body, Input, SafetyEllipse, Scene, Trajectory};

/// Free space to the side of an obstacle, for 1/10 scale cars \[m\]: 0.7 m of a real one.
const SIDE_M: f64 = 0.07;
/// Of it, a plan keeps at least this share.
const KEPT_SIDE_SHARE: f64 = 0.9;
/// A vehicle in the way reaches within this distance of the path, for 1/10 scale cars \[m\].
const NEAR_PATH_M: f64 = 0.02;
/// An obstacle is looked for as far ahead as a driver comes in this time at the speed that it wants, for 1/10 scale cars \[s\].
const LOOK_AHEAD_S: f64 = 2.5;
/// Somebody who stands for longer than this is no part of a queue any more, for 1/10 scale cars \[s\].
const PARKED_S: f64 = 4.0;
/// Somebody who has another one ahead within this many lengths of a car stands in a queue.
const QUEUE_LENGTHS: f64 = 2.5;
/// A driver waits this many lengths of its body behind an obstacle.
const WAITING_LENGTHS: f64 = 2.2;
/// The guessed motion accelerates with at most this share of the strongest acceleration.
const GUESSED_ACCELERATION_SHARE: f64 = 0.3;
/// An ellipse `a × b` around a body that is `l` long contains it where `a = 1.8 l / 2` and `b` reaches this multiple of the way from
/// corner to corner; see [`Obstacle::ellipse`].
const ELLIPSE_LENGTH_RATIO: f64 = 1.8;

/// Something that stands in the way and is no queue.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Obstacle {
    /// The vehicle.
    pub name: String,
    /// Where it begins and ends, along the driver's route \[m\].
    pub along_m: [f64; 2],
    /// Where its middle is across the driver's route \[m\].
    across_m: f64,
    /// The lateral position at which it is passed \[m\].
    pub pass_at_m: f64,
    /// Half the lengths and half the widths of both, together \[m\].
    reach_m: [f64; 2],
}

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

/// What a driver remembers of those who stand.
#[derive(Clone, Debug, Default)]
pub(crate) struct ObstacleMemory {
    /// Since which tick each has been standing; 0 if it stood when it was first seen.
    standing_since: BTreeMap<String, usize>,
    /// Who is being passed.
    passing: Option<String>,
}

impl ObstacleMemory {
    /// The name of what is being passed.
    pub(crate) fn passing(&self) -> Option<&str> {
        self.passing.as_deref()
    }

    /// What to do about the nearest obstacle on the way; none without one. To be called once a tick.
    pub(crate) fn judge(&mut self, scene: &Scene) -> Option<Manoeuvre> {
        // Straight roads have no lanes of which one is somebody else's.
        if !scene.ego.route.is_in_network() {
            return None;
        }
        self.note(scene);
        let found = self.nearest(scene);
        let Some(obstacle) = found else {
            self.passing = None;
            return None;
        };
        let is_under_way = self.passing.as_ref() == Some(&obstacle.name);
        let Some(obstacle) = obstacle.with_side(scene) else {
            return Some(Manoeuvre::Wait(obstacle, None));
        };
        match room::in_the_way(scene, &obstacle, is_under_way) {
            None => {
                self.passing = Some(obstacle.name.clone());
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
            } else {
                self.standing_since.remove(&other.name);
            }
        }
    }

    /// The nearest obstacle whose end is not passed yet.
    fn nearest(&self, scene: &Scene) -> Option<Obstacle> {
        let ego = &scene.ego;
        let (own_m, wanted_mps) = (ego.route.along(ego.state.position()), scene.goal.target.speed_mps);
        let reach_m = LOOK_AHEAD_S * ego.body.time_ratio() * wanted_mps.max(ego.state.speed_mps) + ego.body.front_m;
        let goal_m = ego.route.across(scene.goal.target.position());
        let here_m = ego.route.across(ego.state.position());
        let candidates = scene.others.iter().filter(|other| is_standing(other) && !self.is_queueing(scene, other));
        let obstacles = candidates.filter_map(|other| {
            let at = ego.route.locate(other.state.position(), None);
            let reach = [
                0.5 * (ego.body.front_m + ego.body.rear_m + other.body.front_m + other.body.rear_m),
                0.5 * (ego.body.width_m + other.body.width_m),
            ];
            let blocks = |lateral_m: f64| (at.across_m - lateral_m).abs() < reach[1] + NEAR_PATH_M * ego.body.scale;
            let along_m = [at.along_m - other.body.rear_m, at.along_m + other.body.front_m];
            let is_ahead = along_m[1] > own_m - ego.body.rear_m && along_m[0] < own_m + reach_m;
            let found = Obstacle {
                name: other.name.clone(),
                along_m,
                across_m: at.across_m,
                pass_at_m: at.across_m,
                reach_m: reach,
            };
            (is_ahead && (blocks(goal_m) || (blocks(here_m) && at.along_m > own_m))).then_some(found)
        });
        obstacles.min_by(|a, b| a.along_m[0].total_cmp(&b.along_m[0]))
    }

    /// Whether a vehicle that stands waits in a queue: at a line, or behind somebody.
    fn is_queueing(&self, scene: &Scene, other: &Agent) -> bool {
        let since = self.standing_since.get(&other.name).copied().unwrap_or(scene.tick);
        let stood_s = (scene.tick - since) as f64 * scene.step_s;
        if since == 0 || stood_s > PARKED_S * scene.ego.body.time_ratio() {
            return other.rules.stop_line_m.is_some();
        }
        let length_m = scene.ego.body.front_m + scene.ego.body.rear_m;
        let others = scene.others.iter().filter(|third| third.name != other.name);
        let is_next = |third: &Agent| {
            let lead_m = other.lead_of(third);
            other.shares_lane_with(third) && lead_m > 0.0 && lead_m < (QUEUE_LENGTHS + 1.0) * length_m
        };
        other.rules.stop_line_m.is_some() || others.into_iter().any(is_next)
    }
}

impl Obstacle {
    /// The obstacle with the side on which there is room for a body on the road, the left one first; none if there is on neither.
    fn with_side(&self, scene: &Scene) -> Option<Obstacle> {
        let ego = &scene.ego;
        let beside_m = self.reach_m[1] + SIDE_M * ego.body.scale;
        let middle_m = 0.5 * (self.along_m[0] + self.along_m[1]);
        let [right_m, left_m] = ego.route.edges_before_end_m(middle_m);
        let half_m = 0.5 * ego.body.width_m;
        let sides = [self.across_m + beside_m, self.across_m - beside_m];
        let pass_at_m = sides.into_iter().find(|at_m| (right_m + half_m..=left_m - half_m).contains(at_m))?;
        Some(Obstacle { pass_at_m, ..self.clone() })
    }

    /// How far the front of a driver comes who waits behind it, with room to swing out later \[m\].
    pub(crate) fn line_m(&self, scene: &Scene) -> f64 {
        self.along_m[0] - WAITING_LENGTHS * (scene.ego.body.front_m + scene.ego.body.rear_m)
    }

    /// The inputs of a driver who passes it, accelerating a little: a guess from which plans begin.
    pub(crate) fn guess(&self, scene: &Scene) -> Vec<Input> {
        let ego = &scene.ego;
        let (swing_m, own_m) = (swing_m(scene), ego.route.across(scene.goal.target.position()));
        let most_mps2 = GUESSED_ACCELERATION_SHARE * ego.limits.acceleration_max_mps2;
        let motion = roll_out(scene, |_, state| {
            let along_m = ego.route.along(state.position());
            let wanted_mps2 = (scene.goal.target.speed_mps - state.speed_mps) / scene.step_s;
            Input {
                acceleration_mps2: admissible(ego, state, wanted_mps2.min(most_mps2), scene.step_s),
                steering_rad: steer(ego, state, self.lateral_m(along_m + ego.body.front_m, own_m, swing_m)),
            }
        });
        motion.inputs
    }

    /// Whether a motion of the planning vehicle touches it, or comes nearer than half of a free space at each side.
    pub(crate) fn is_touched_by(&self, scene: &Scene, motion: &Trajectory, spaces: f64) -> bool {
        let Some(other) = scene.others.iter().find(|other| other.name == self.name) else { return false };
        let body = Body { width_m: other.body.width_m + spaces * SIDE_M * scene.ego.body.scale, ..other.body };
        touches_ahead(scene, motion, &Agent { body, ..other.clone() })
    }

    /// What keeps the driver beside it.
    pub(crate) fn keep_out(&self, scene: &Scene) -> KeepOut {
        let route = &scene.ego.route;
        let middle_m = 0.5 * (self.along_m[0] + self.along_m[1]);
        let centres = vec![route.position(middle_m, self.across_m); scene.horizon];
        let ellipse = self.ellipse(scene.ego.body.scale);
        KeepOut { vehicle: 0, ellipses: ellipses(ellipse, route, &centres), centres, penalty: Penalty::EXACT }
    }

    /// The ellipse around its middle that the middle of the driver's body stays out of: it contains all places at which the bodies would
    /// be nearer to each other than the free space to the side.
    pub(crate) fn ellipse(&self, scale: f64) -> SafetyEllipse {
        let along_m = ELLIPSE_LENGTH_RATIO * self.reach_m[0];
        let share = (1.0 - ELLIPSE_LENGTH_RATIO.powi(-2)).sqrt();
        SafetyEllipse { along_m, across_m: (self.reach_m[1] + KEPT_SIDE_SHARE * SIDE_M * scale) / share }
    }

    /// The lateral position at which a driver is who passes it, at an arc length \[m\]; `own_m` is where it is otherwise.
    pub(crate) fn lateral_m(&self, along_m: f64, own_m: f64, swing_m: f64) -> f64 {
        let [from_m, to_m] = [self.along_m[0] - swing_m, self.along_m[1] + self.reach_m[0]];
        if (from_m..to_m).contains(&along_m) { self.pass_at_m } else { own_m }
    }
}

/// The length in which a driver changes to the position beside an obstacle, at a speed \[m\].
pub(crate) fn swing_m(scene: &Scene) -> f64 {
    let ego = &scene.ego;
    SWING_LENGTHS * (ego.body.front_m + ego.body.rear_m) + SWING_S * ego.body.time_ratio() * ego.state.speed_mps
}

/// A driver swings out over this many lengths of its body, and over what it drives in this time of 1/10 scale cars \[s\].
const SWING_LENGTHS: f64 = 1.5;
const SWING_S: f64 = 0.6;
