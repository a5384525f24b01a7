//! Whether there is room to pass an obstacle: no other vehicle comes to the part of the road that is borrowed before the driver is back.

use super::standing::{WAITING_LENGTHS, swing_m};
use crate::scene::relation::is_standing;
use crate::scene::road_rules::Obstacle;
use crate::{Agent, Scene};

/// Time to spare before another vehicle is there, for 1/10 scale cars \[s\]: 2.5 s of a real one.
const SPARE_S: f64 = 0.8;
/// The same for a driver who has begun to pass and could still stop before the obstacle.
const SPARE_UNDER_WAY_S: f64 = 0.0;
/// Who has begun to pass and would have to brake harder than this to stop before the obstacle goes on \[m/s²\].
const STOPPING_MPS2: f64 = 2.5;
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
    others.into_iter().find(|other| comes_into(scene, other, obstacle, zone_m, until_s))
}

/// Whether an obstacle without a driver stands.
fn is_parked(other: &Agent) -> bool {
    other.is_obstacle && is_standing(other)
}

/// Where a row of obstacles ends that begins with one and between which no room is left to come back into the lane and to wait \[m\].
pub(super) fn end_of_row_m(scene: &Scene, obstacle: &Obstacle) -> f64 {
    let ego = &scene.ego;
    let length_m = ego.body.front_m + ego.body.rear_m;
    let room_m = swing_m(&scene.ego, SPEED_SHARE * scene.goal.target.speed_mps) + (1.0 + WAITING_LENGTHS) * length_m;
    let standing = scene.others.iter().filter(|other| is_standing(other)).filter_map(|other| {
        let at = ego.route.locate(other.state.position(), None);
        let is_in_row = (at.across_m - obstacle.across_m).abs() < 0.5 * (ego.body.width_m + other.body.width_m);
        is_in_row.then_some([at.along_m - other.body.rear_m, at.along_m + other.body.front_m])
    });
    let mut row: Vec<[f64; 2]> = standing.filter(|[from_m, _]| *from_m > obstacle.along_m[0]).collect();
    row.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let joined = |end_m: f64, [from_m, to_m]: [f64; 2]| if from_m < end_m + room_m { to_m } else { end_m };
    row.into_iter().fold(obstacle.along_m[1], joined)
}

/// The time for a way from now on, accelerating to a share of the wanted speed \[s\].
fn time_s(scene: &Scene, way_m: f64) -> f64 {
    let ego = &scene.ego;
    let acceleration_mps2 = ACCELERATION_SHARE * ego.limits.acceleration_max_mps2;
    let now_mps = ego.state.speed_mps;
    let most_mps = (SPEED_SHARE * scene.goal.target.speed_mps).max(now_mps);
    let until_s = (most_mps - now_mps) / acceleration_mps2;
    let until_m = 0.5 * (now_mps + most_mps) * until_s;
    if way_m <= until_m {
        return ((now_mps * now_mps + 2.0 * acceleration_mps2 * way_m).sqrt() - now_mps) / acceleration_mps2;
    }
    if most_mps > 0.0 { until_s + (way_m - until_m) / most_mps } else { f64::INFINITY }
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
    // A vehicle behind in the own lane waits as well, and one that drives ahead in the same direction leaves.
    let is_behind = at.along_m < own_m && (at.across_m - ego.across_m()).abs() < reach_m;
    let leaves = along_mps > ego.state.speed_mps && at.along_m > zone_m[1];
    covered_m[1] > zone_m[0] && covered_m[0] < zone_m[1] && !is_behind && !leaves
}
