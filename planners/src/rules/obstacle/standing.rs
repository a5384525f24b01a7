//! A vehicle that stands in the way: where it is, and how it is passed.

use crate::plan::certificate::touches_ahead;
use crate::prediction::steering::{admissible, roll_out, steer};
use crate::problem::clearance::{STANDSTILL_GAP_M, containing, ellipses};
use crate::scene::road_rules::Obstacle;
use crate::trajectory::Penalty;
use crate::trajectory::terms::KeepOut;
use crate::{Agent, Body, Input, Scene, Trajectory};

/// Free space to the side of an obstacle, for 1/10 scale cars \[m\]: 0.9 m of a real one.
const SIDE_M: f64 = 0.09;
/// Least free space to each side in a gap between obstacles, for 1/10 scale cars \[m\]: 0.3 m of a real one.
const LEAST_SIDE_M: f64 = 0.03;
/// Of the free space, a plan keeps at least this share.
const KEPT_SIDE_SHARE: f64 = 0.75;
/// A driver waits this many lengths of its body behind an obstacle.
pub(super) const WAITING_LENGTHS: f64 = 2.2;
/// A driver that would have to brake harder than this for the usual distance stops nearer to the obstacle \[m/s²\].
const STOPPING_MPS2: f64 = 3.0;
/// The guessed motion accelerates with at most this share of the strongest acceleration.
const GUESSED_ACCELERATION_SHARE: f64 = 0.3;
/// A driver swings out over this many lengths of its body,
const SWING_LENGTHS: f64 = 1.5;
/// and over what it drives in this time of 1/10 scale cars \[s\].
const SWING_S: f64 = 0.6;

impl Obstacle {
    /// The obstacle with the side on which there is room for a body between the edges of the road and other obstacles, the left one
    /// first; none if there is on neither. Where the usual free space does not fit, the driver keeps to the middle of the gap.
    pub(super) fn with_side(&self, scene: &Scene) -> Option<Obstacle> {
        let (ego, scale) = (&scene.ego, scene.ego.body.scale);
        let half_m = 0.5 * ego.body.width_m;
        let [right_m, left_m] = self.free_between_m(scene);
        let [least_m, usual_m] = [LEAST_SIDE_M, SIDE_M].map(|side_m| self.reach_m[1] + side_m * scale);
        let left_m = [self.across_m + least_m, left_m - half_m];
        let right_m = [right_m + half_m, self.across_m - least_m];
        let usual = [(self.across_m + usual_m, left_m), (self.across_m - usual_m, right_m)];
        let usual =
            usual.into_iter().find(|(at_m, [from_m, to_m])| (from_m..=to_m).contains(&at_m)).map(|(at_m, _)| at_m);
        let narrow = || [left_m, right_m].into_iter().find(|[from_m, to_m]| from_m <= to_m);
        let pass_at_m = usual.or_else(|| narrow().map(|[from_m, to_m]| 0.5 * (from_m + to_m)))?;
        Some(Obstacle { pass_at_m, ..self.clone() })
    }

    /// Between which lateral coordinates the road is free beside the obstacle: up to the edges of the road, or to obstacles on the other
    /// side of the way past it, less the least space beside those \[m\].
    fn free_between_m(&self, scene: &Scene) -> [f64; 2] {
        let ego = &scene.ego;
        let middle_m = 0.5 * (self.along_m[0] + self.along_m[1]);
        let length_m = ego.body.front_m + ego.body.rear_m;
        let opposite = scene.others.iter().filter(|other| other.is_obstacle && other.name != self.name);
        let opposite = opposite.map(|other| (ego.route.locate(other.state.position(), None), &other.body));
        let beside = opposite.filter(|(at, body)| {
            at.along_m + body.front_m + length_m > self.along_m[0]
                && at.along_m - body.rear_m - length_m < self.along_m[1]
        });
        beside.fold(ego.route.edges_before_end_m(middle_m), |[right_m, left_m], (at, body)| {
            let space_m = 0.5 * body.width_m + LEAST_SIDE_M * ego.body.scale;
            let apart_m = at.across_m - self.across_m;
            if apart_m > self.reach_m[1] {
                [right_m, left_m.min(at.across_m - space_m)]
            } else if apart_m < -self.reach_m[1] {
                [right_m.max(at.across_m + space_m), left_m]
            } else {
                [right_m, left_m]
            }
        })
    }

    /// The free space beside it on the way past it: the usual one, or less in a gap \[m\].
    fn side_m(&self, scene: &Scene) -> f64 {
        let side_m = (self.pass_at_m - self.across_m).abs() - self.reach_m[1];
        side_m.clamp(0.0, SIDE_M * scene.ego.body.scale)
    }

    /// Whether another vehicle is passed with it: it is the obstacle itself, or one of its row beside the way past it.
    pub(crate) fn is_passed_with(&self, ego: &Agent, other: &Agent) -> bool {
        let at = ego.route.locate(other.state.position(), None);
        let is_in_row = (self.along_m[0]..self.row_end_m).contains(&at.along_m);
        let is_beside = (at.across_m - self.pass_at_m).abs() >= 0.5 * (ego.body.width_m + other.body.width_m);
        self.name == other.name || other.is_obstacle && is_in_row && is_beside
    }

    /// How far the front of a driver comes who waits behind it, with room to swing out later; nearer for a driver who sees only late that
    /// it is an obstacle, and stops in comfort \[m\].
    pub(crate) fn line_m(&self, scene: &Scene) -> f64 {
        let Agent { body, state, route, .. } = &scene.ego;
        let line_m = self.along_m[0] - WAITING_LENGTHS * (body.front_m + body.rear_m);
        if !scene.knowledge.is_of_motion() {
            return line_m;
        }
        let stopping_m = state.speed_mps * state.speed_mps / (2.0 * STOPPING_MPS2);
        let reached_m = route.along(state.position()) + body.front_m + stopping_m;
        line_m.max(reached_m.min(self.along_m[0] - STANDSTILL_GAP_M * body.scale))
    }

    /// Whether a driver could not stop before it any more, however hard it brakes.
    pub(super) fn is_beyond_braking(&self, scene: &Scene) -> bool {
        let ego = &scene.ego;
        let room_m = self.along_m[0] - ego.along_m() - ego.body.front_m;
        ego.state.speed_mps * ego.state.speed_mps > -2.0 * ego.limits.acceleration_min_mps2 * room_m
    }

    /// The inputs of a driver who passes it, accelerating a little: a guess from which plans begin.
    pub(crate) fn guess(&self, scene: &Scene) -> Vec<Input> {
        let ego = &scene.ego;
        let (swing_m, own_m) = (swing_m(ego, ego.state.speed_mps), ego.route.across(scene.goal.target.position()));
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

    /// Whether a driver who sees late that it is an obstacle has come so near that it cannot swing out beside it.
    pub(super) fn is_too_near_to_swing_out(&self, scene: &Scene) -> bool {
        let Agent { body, state, route, .. } = &scene.ego;
        let room_m = self.along_m[0] - route.along(state.position()) - body.front_m;
        let aside_m = (self.reach_m[1] - (route.across(state.position()) - self.across_m).abs()).max(0.0);
        scene.knowledge.is_of_motion() && scene.ego.is_too_near_to_swing_out(room_m, aside_m)
    }

    /// Whether a plan leads less far than its vehicle is long. Behind an obstacle that may be passed, a descent that begins there stays
    /// there.
    pub(crate) fn keeps_back(&self, scene: &Scene, plan: &Trajectory) -> bool {
        let (body, ends) = (&scene.ego.body, plan.states.first().zip(plan.states.last()));
        ends.is_none_or(|(from, to)| libm::hypot(to.x_m - from.x_m, to.y_m - from.y_m) < body.front_m + body.rear_m)
    }

    /// Whether a motion of the planning vehicle touches it, or comes nearer than half of a free space at each side.
    pub(crate) fn is_touched_by(&self, scene: &Scene, motion: &Trajectory, spaces: f64) -> bool {
        let Some(other) = scene.others.iter().find(|other| other.name == self.name) else { return false };
        let body = Body { width_m: other.body.width_m + spaces * self.side_m(scene), ..other.body };
        touches_ahead(scene, motion, &Agent { body, ..other.clone() })
    }

    /// What keeps the driver beside it: the middle of its body stays out of an ellipse that contains all places at which the bodies would
    /// be nearer to each other than the free space to the side.
    pub(crate) fn keep_out(&self, scene: &Scene) -> KeepOut {
        let route = &scene.ego.route;
        let middle_m = 0.5 * (self.along_m[0] + self.along_m[1]);
        let centres = vec![route.position(middle_m, self.across_m); scene.horizon];
        let [length_m, width_m] = self.reach_m;
        let usual = containing(length_m, width_m + KEPT_SIDE_SHARE * self.side_m(scene));
        let is_in_gap = self.side_m(scene) < SIDE_M * scene.ego.body.scale;
        let ellipse =
            if is_in_gap { usual.fitting(length_m, width_m, (self.pass_at_m - self.across_m).abs()) } else { usual };
        KeepOut { vehicle: 0, ellipses: ellipses(ellipse, route, &centres), centres, penalty: Penalty::EXACT }
    }

    /// The lateral position at which a driver is who passes it, at an arc length \[m\]; `own_m` is where it is otherwise.
    pub(crate) fn lateral_m(&self, along_m: f64, own_m: f64, swing_m: f64) -> f64 {
        let [from_m, to_m] = [self.along_m[0] - swing_m, self.row_end_m + self.reach_m[0]];
        if (from_m..to_m).contains(&along_m) { self.pass_at_m } else { own_m }
    }
}

/// The length in which a driver changes to the position beside an obstacle, at a speed \[m\].
pub(crate) fn swing_m(ego: &Agent, speed_mps: f64) -> f64 {
    SWING_LENGTHS * (ego.body.front_m + ego.body.rear_m) + SWING_S * ego.body.time_ratio() * speed_mps
}
