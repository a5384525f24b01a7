//! Whether there is room to pass an obstacle: no other vehicle comes to the part of the road that is borrowed before the driver is back.

use std::f64::consts::FRAC_1_SQRT_2;

use super::standing::{WAITING_LENGTHS, swing_m};
use crate::rules::giving_way;
use crate::scene::relation::is_standing;
use crate::scene::road_rules::Obstacle;
use crate::{Agent, Scene};

/// Time to spare before another vehicle is there, for 1/10 scale cars \[s\]: 2.5 s of a real one.
const SPARE_S: f64 = 0.8;
/// The same for a driver who has begun to pass and could still stop before the obstacle.
const SPARE_UNDER_WAY_S: f64 = 0.0;
/// Who has begun to pass and would have to brake harder than this to stop before the obstacle goes on \[m/s²\].
const STOPPING_MPS2: f64 = 2.5;
/// Time to the next vehicle in a lane into which a driver swings out, at the speed with which it closes up and, of the one behind, half
/// its own, for 1/10 scale cars \[s\]: 1.6 s of a real one.
const GAP_S: f64 = 0.5;
/// Two vehicles are equally near to what each has to pass if this is the difference, for 1/10 scale cars \[m\].
const EQUALLY_NEAR_M: f64 = 0.1;
/// An oncoming vehicle is about to leave its lane within this many times the way in which it does.
const APPROACH_SWINGS: f64 = 2.0;
/// A driver passes with this share of its strongest acceleration.
const ACCELERATION_SHARE: f64 = 0.3;
/// A driver who passes drives at most this share of the speed that it wants.
const SPEED_SHARE: f64 = 0.8;

/// Who would be in the way of passing an obstacle and its row, which ends at `end_m`; none if no vehicle is, or if the driver has gone too
/// far to go back.
pub(super) fn in_the_way<'a>(
    scene: &'a Scene,
    obstacle: &Obstacle,
    end_m: f64,
    is_under_way: bool,
) -> Option<&'a Agent> {
    let ego = &scene.ego;
    let own_m = ego.along_m();
    let room_m = obstacle.along_m[0] - own_m - ego.body.front_m;
    if is_under_way && ego.state.speed_mps * ego.state.speed_mps > 2.0 * STOPPING_MPS2 * room_m {
        return None;
    }
    let swing_m = swing_m(ego, ego.state.speed_mps);
    // From where the driver leaves its lane to where its rear is back in it.
    let zone_m = [(obstacle.along_m[0] - swing_m).max(own_m), end_m + swing_m + ego.body.rear_m];
    let spare_s = if is_under_way { SPARE_UNDER_WAY_S } else { SPARE_S } * ego.body.time_ratio();
    let until_s = time_s(scene, zone_m[1] - own_m) + spare_s;
    // What stands without a driver leaves no more room later.
    let others = scene.others.iter().filter(|other| other.name != obstacle.name && !is_parked(other));
    others.into_iter().find(|other| {
        comes_into(scene, other, obstacle, zone_m, until_s)
            || !is_under_way && leaves_its_lane_first(scene, other, zone_m, room_m)
    })
}

/// Whether an oncoming vehicle has an obstacle of its own to pass, where it comes into the zone of the driver, and is nearer to it than the
/// driver to its own, `room_m`. If both are as near, the one whose name comes first in the alphabet goes.
fn leaves_its_lane_first(scene: &Scene, other: &Agent, zone_m: [f64; 2], room_m: f64) -> bool {
    let ego = &scene.ego;
    let at = ego.route.locate(other.state.position(), None);
    if !scene.knowledge.is_of_motion() || libm::cos(other.state.heading_rad - at.heading_rad) > -FRAC_1_SQRT_2 {
        return false;
    }
    let front_m = at.along_m - other.body.front_m;
    let swing_m = swing_m(&scene.ego, other.state.speed_mps);
    let nearest = scene.others.iter().filter(|third| is_parked(third)).filter_map(|third| {
        let place = ego.route.locate(third.state.position(), None);
        let reach_m = 0.5 * (other.body.width_m + third.body.width_m);
        let end_m = place.along_m + third.body.front_m.max(third.body.rear_m);
        let blocks = (place.across_m - at.across_m).abs() < reach_m && end_m < front_m + other.body.front_m;
        blocks.then_some(end_m)
    });
    let Some(end_m) = nearest.max_by(f64::total_cmp) else { return false };
    let their_room_m = (front_m - end_m).max(0.0);
    let tolerance_m = EQUALLY_NEAR_M * ego.body.scale;
    let is_nearer = their_room_m < room_m - tolerance_m || their_room_m < room_m + tolerance_m && other.name < ego.name;
    is_nearer && end_m - swing_m < zone_m[1] && their_room_m < APPROACH_SWINGS * swing_m
}

/// Whether an obstacle without a driver stands.
fn is_parked(other: &Agent) -> bool {
    other.is_obstacle && is_standing(other)
}

/// An obstacle with the row that it begins, between which no room is left to come back into the lane and to wait: where that ends, and the
/// lateral position at which all of it is passed.
pub(super) fn with_row(scene: &Scene, obstacle: Obstacle) -> Obstacle {
    let ego = &scene.ego;
    let length_m = ego.body.front_m + ego.body.rear_m;
    let room_m = swing_m(&scene.ego, SPEED_SHARE * scene.goal.target.speed_mps) + (1.0 + WAITING_LENGTHS) * length_m;
    let standing = scene.others.iter().filter(|other| is_standing(other)).filter_map(|other| {
        let at = ego.route.locate(other.state.position(), None);
        let is_in_row = (at.across_m - obstacle.across_m).abs() < 0.5 * (ego.body.width_m + other.body.width_m);
        is_in_row.then_some(([at.along_m - other.body.rear_m, at.along_m + other.body.front_m], at.across_m, other))
    });
    let mut row: Vec<([f64; 2], f64, &Agent)> =
        standing.filter(|([from_m, _], ..)| *from_m > obstacle.along_m[0]).collect();
    row.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    let side_m = obstacle.pass_at_m - obstacle.across_m;
    let mut whole = obstacle;
    for ([from_m, to_m], across_m, other) in row {
        if from_m >= whole.row_end_m + room_m {
            continue;
        }
        whole.row_end_m = to_m;
        if other.is_obstacle {
            let wider_m = 0.5 * (ego.body.width_m + other.body.width_m) - whole.reach_m[1];
            let pass_at_m = across_m + side_m + wider_m.copysign(side_m);
            let [right_m, left_m] = ego.route.edges_before_end_m(from_m);
            whole.pass_at_m = if side_m > 0.0 {
                whole.pass_at_m.max(pass_at_m.min(left_m - 0.5 * ego.body.width_m))
            } else {
                whole.pass_at_m.min(pass_at_m.max(right_m + 0.5 * ego.body.width_m))
            };
        }
    }
    whole
}

/// The time for a way from now on, accelerating to a share of the wanted speed \[s\].
fn time_s(scene: &Scene, way_m: f64) -> f64 {
    let Scene { ego, goal, .. } = scene;
    let acceleration_mps2 = ACCELERATION_SHARE * ego.limits.acceleration_max_mps2;
    giving_way::time_s(way_m, ego.state.speed_mps, SPEED_SHARE * goal.target.speed_mps, acceleration_mps2)
}

/// Whether a vehicle that keeps its speed is on the borrowed strip within some time, or comes up from behind.
fn comes_into(scene: &Scene, other: &Agent, obstacle: &Obstacle, zone_m: [f64; 2], until_s: f64) -> bool {
    let ego = &scene.ego;
    let at = ego.route.locate(other.state.position(), None);
    let (sin, cos) = libm::sincos(other.state.heading_rad - at.heading_rad);
    let (along_mps, across_mps) = (other.state.speed_mps * cos, other.state.speed_mps * sin);
    let reach_m = 0.5 * (ego.body.width_m + other.body.width_m);
    let laterals_m = [at.across_m, at.across_m + across_mps * until_s];
    let strip_m = [obstacle.pass_at_m - reach_m, obstacle.pass_at_m + reach_m];
    let is_on_strip = laterals_m[0].min(laterals_m[1]) < strip_m[1] && laterals_m[0].max(laterals_m[1]) > strip_m[0];
    if !is_on_strip {
        return false;
    }
    let half_m = other.body.front_m.max(other.body.rear_m);
    let ends_m = [at.along_m, at.along_m + along_mps * until_s];
    let covered_m = [ends_m[0].min(ends_m[1]) - half_m, ends_m[0].max(ends_m[1]) + half_m];
    let own_m = ego.along_m();
    if !ego.route.is_in_network() && along_mps >= 0.0 {
        return leaves_no_gap(scene, other, at.along_m, along_mps, zone_m[0]);
    }
    // A vehicle behind in the own lane waits as well, and one that drives ahead in the same direction leaves.
    let is_behind = at.along_m < own_m && (at.across_m - ego.across_m()).abs() < reach_m;
    let leaves = along_mps > ego.state.speed_mps && at.along_m > zone_m[1];
    covered_m[1] > zone_m[0] && covered_m[0] < zone_m[1] && !is_behind && !leaves
}

/// Whether a vehicle that drives in the same direction on the strip leaves the driver no gap when it swings out at `from_m`: from then on
/// the one behind follows.
fn leaves_no_gap(scene: &Scene, other: &Agent, along_m: f64, along_mps: f64, from_m: f64) -> bool {
    let ego = &scene.ego;
    let own_m = ego.along_m();
    let swung_s = time_s(scene, from_m + swing_m(&scene.ego, ego.state.speed_mps) - own_m);
    let ahead_m = along_m + along_mps * swung_s - from_m - swing_m(&scene.ego, ego.state.speed_mps);
    let gap_s = GAP_S * ego.body.time_ratio();
    if ahead_m > 0.0 {
        return ahead_m - other.body.rear_m - ego.body.front_m < gap_s * (ego.state.speed_mps - along_mps).max(0.0);
    }
    let closing_mps = (along_mps - ego.state.speed_mps).max(0.0);
    -ahead_m - other.body.front_m - ego.body.rear_m < gap_s * (0.5 * along_mps + closing_mps)
}
