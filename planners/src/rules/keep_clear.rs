//! Room behind a junction: no vehicle enters a way that crosses its own, such as a zebra crossing, unless it can leave it again.

use crate::Agent;
use crate::road::network::RouteConflict;
use crate::rules::giving_way::{can_stop, front_m, length_m, stopping_distance_m};

/// A vehicle ahead below this speed stands, or will stand, for 1/10 scale cars \[m/s\]: 1.6 m/s of a real one.
const CREEPING_MPS: f64 = 0.5;
/// Distance that a vehicle leaves to the one ahead when it stands, for 1/10 scale cars \[m\].
const GAP_M: f64 = 0.25;

/// The line before the first crossing way on which a vehicle would come to stand, along its route \[m\], and the vehicle behind which it
/// would stand; none if there is room behind each of them.
pub(super) fn line_m<'a>(ego: &Agent, others: impl Iterator<Item = &'a Agent>) -> Option<(f64, &'a Agent)> {
    if ego.route.legs.iter().any(|leg| leg.is_zebra) {
        return None;
    }
    let (front_m, before_m, length_m) = (front_m(ego), stopping_distance_m(ego), length_m(ego));
    let mut crossed: Vec<&RouteConflict> = ego.route.crossings().filter(|way| way.own_line_m >= front_m).collect();
    if crossed.is_empty() {
        return None;
    }
    crossed.sort_by(|a, b| b.own_line_m.total_cmp(&a.own_line_m));
    let (mut place_m, ahead) = standing_place_m(ego, others)?;
    let mut line_m = None;
    for way in crossed {
        let is_blocked = way.own_m[0] < place_m && place_m - length_m < way.own_m[1];
        if is_blocked && can_stop(ego, way.own_line_m - before_m) {
            place_m = way.own_line_m;
            line_m = Some(way.own_line_m);
        }
    }
    line_m.map(|line_m| (line_m, ahead))
}

/// Where the front of a vehicle will be when it stands behind the queue ahead in its lane \[m\], and the last vehicle of that queue; none
/// if no vehicle stands ahead.
fn standing_place_m<'a>(ego: &Agent, others: impl Iterator<Item = &'a Agent>) -> Option<(f64, &'a Agent)> {
    let own_m = ego.along_m();
    let in_lane = others.filter_map(|other| {
        let at = ego.route.locate(other.state.position(), None);
        let is_along = libm::cos(other.state.heading_rad - at.heading_rad) > std::f64::consts::FRAC_1_SQRT_2;
        let is_in_lane = at.across_m.abs() < 0.5 * (ego.body.width_m + other.body.width_m);
        (at.along_m > own_m && is_in_lane && is_along).then_some((at.along_m, other))
    });
    let mut ahead: Vec<(f64, &Agent)> = in_lane.collect();
    ahead.sort_by(|a, b| a.0.total_cmp(&b.0));
    let gap_m = GAP_M * ego.body.scale;
    let mut taken_m = 0.0;
    for (along_m, other) in ahead {
        if other.state.speed_mps < CREEPING_MPS * ego.body.time_ratio() {
            return Some((along_m - other.body.rear_m - gap_m - taken_m, other));
        }
        taken_m += length_m(other) + gap_m;
    }
    None
}
