//! A vehicle that comes head-on in the own lane: the driver brakes so that it stands where both would meet, and keeps to the right edge.

use crate::scene::relation::is_standing;
use crate::{Agent, Scene};

/// A vehicle whose direction differs by more than this from that of the road comes the other way \[rad\].
const OPPOSITE_RAD: f64 = 2.36;
/// A vehicle is in the way if its body is nearer to the place of the own body in its lane than this, for 1/10 scale cars \[m\].
const ASIDE_M: f64 = 0.03;
/// Distance that is kept to the edge of the lane, for 1/10 scale cars \[m\].
const EDGE_M: f64 = 0.02;
/// A meeting later than this is not yet minded, for 1/10 scale cars \[s\]: 10 s of a real one.
const SOON_S: f64 = 3.2;
/// Distance between both vehicles when they stand, for 1/10 scale cars \[m\].
const GAP_M: f64 = 0.2;

/// Where a driver avoids a vehicle that comes head-on in its lane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Evasion {
    /// The vehicle.
    pub name: String,
    /// How far its front may come along its route \[m\].
    pub line_m: f64,
    /// Where it drives beside the centre line of its route: at the right edge of its lane \[m\].
    pub across_m: f64,
}

/// What a driver does about the nearest vehicle that comes head-on in its lane; none without one.
pub(super) fn evasion(scene: &Scene) -> Option<Evasion> {
    let ego = &scene.ego;
    if !ego.route.is_in_network() {
        return None;
    }
    let own_m = ego.along_m();
    let front_m = own_m + ego.body.front_m;
    let met = scene.others.iter().filter_map(|other| Some((meeting_m(scene, other, front_m)?, other)));
    let (line_m, other) = met.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let edge_m = ego.route.half_width.value(own_m) - 0.5 * ego.body.width_m - EDGE_M * ego.body.scale;
    Some(Evasion { name: other.name.clone(), line_m, across_m: -edge_m.max(0.0) })
}

/// How far a front at `front_m` comes until it meets a vehicle that comes head-on in the lane, at the present speeds of both; none if
/// that is not in the way, or is far away \[m\].
fn meeting_m(scene: &Scene, other: &Agent, front_m: f64) -> Option<f64> {
    let ego = &scene.ego;
    if other.is_obstacle || is_standing(other) {
        return None;
    }
    let at = ego.route.locate(other.state.position(), None);
    let is_opposite = libm::cos(other.state.heading_rad - at.heading_rad) < libm::cos(OPPOSITE_RAD);
    let lane_m = ego.route.across(scene.goal.target.position());
    let reach_m = 0.5 * (ego.body.width_m + other.body.width_m) + ASIDE_M * ego.body.scale;
    let apart_m = at.along_m - other.body.front_m - front_m;
    if !is_opposite || apart_m < 0.0 || (at.across_m - lane_m).abs() > reach_m {
        return None;
    }
    let closing_mps = ego.state.speed_mps + other.state.speed_mps;
    if apart_m > closing_mps * SOON_S * ego.body.time_ratio() {
        return None;
    }
    let room_m = (apart_m - GAP_M * ego.body.scale).max(0.0);
    Some(front_m + room_m * ego.state.speed_mps / closing_mps)
}
