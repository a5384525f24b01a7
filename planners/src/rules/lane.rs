//! Who stays in its lane.

use super::obliged::Obliged;
use super::queue;
use crate::Agent;
use crate::road::centre_line::FrenetPoint;
use crate::scene::relation::is_standing;

/// Of the lane, a vehicle that stays in it may be beyond the line by this much now, for 1/10 scale cars \[m\].
const BEYOND_LINE_M: f64 = 0.02;
/// A vehicle ahead with less than this share of the wanted speed may be overtaken.
const SLOW_SHARE: f64 = 0.75;
/// Vehicles ahead are considered as far as the driver comes in this time at the speed that it wants, for 1/10 scale cars \[s\].
const LOOK_AHEAD_S: f64 = 2.5;
/// Who overtakes drives this many of its lengths further than the other, besides the distance between them.
const OVERTAKING_LENGTHS: f64 = 6.0;
/// Time to spare before an oncoming vehicle arrives, for 1/10 scale cars \[s\].
const SPARE_S: f64 = 0.8;

/// Whether a road user has to stay in the lane of its route: it is in that lane, does not aim for another one, and cannot overtake a slow
/// vehicle ahead. To overtake it needs road beside that vehicle all the way, and to be back before an oncoming vehicle, a light or a
/// crossing way. Stationary vehicles and those that wait are not overtaken.
pub(super) fn stays_in_lane(user: &Obliged<'_>, users: &[Obliged<'_>]) -> bool {
    let ego = &user.agent;
    if !is_in_lane(ego) || user.lateral_goal_m.abs() >= BEYOND_LINE_M * ego.body.scale {
        return false;
    }
    let own_m = ego.along_m();
    let others = users.iter().filter(|other| other.agent.name != ego.name);
    let places = others.map(|other| (other.agent, ego.route.locate(other.agent.state.position(), None)));
    let places: Vec<(&Agent, FrenetPoint)> = places.collect();
    let agents = places.iter().map(|(other, _)| *other);
    let slow = places.iter().filter_map(|(other, at)| {
        let time_s = overtaking_s(user, own_m, other, at)?;
        has_road_beside(ego, other, at.across_m, [own_m, own_m + user.wanted_mps * time_s]).then_some((*other, time_s))
    });
    let times = slow.filter(|(other, _)| !queue::waits(other, agents.clone())).map(|(_, time_s)| time_s);
    let Some(time_s) = times.reduce(f64::max) else { return true };
    is_forbidden(ego, [own_m, own_m + user.wanted_mps * time_s])
        || places.iter().any(|(other, at)| comes_within(user, own_m, other, at, time_s))
}

/// Whether a vehicle is in the lane of its route.
pub(super) fn is_in_lane(ego: &Agent) -> bool {
    ego.route.own_lane().is_some_and(|lane| lane.contains(&ego.body, &ego.state, BEYOND_LINE_M * ego.body.scale))
}

/// How long it takes to overtake a slow vehicle ahead in the lane; none of all others \[s\].
fn overtaking_s(user: &Obliged<'_>, own_m: f64, other: &Agent, at: &FrenetPoint) -> Option<f64> {
    let ego = &user.agent;
    let lead_m = at.along_m - own_m;
    let reach_m = LOOK_AHEAD_S * ego.body.time_ratio() * user.wanted_mps + ego.body.front_m + other.body.rear_m;
    let is_in_lane = at.across_m.abs() < 0.5 * (ego.body.width_m + other.body.width_m);
    let (sin, cos) = libm::sincos(other.state.heading_rad - at.heading_rad);
    let [along_mps, across_mps] = [cos, sin].map(|share| share * other.state.speed_mps);
    let is_slow = along_mps < SLOW_SHARE * user.wanted_mps && across_mps.abs() <= along_mps;
    let is_ahead = (0.0..reach_m).contains(&lead_m) && is_in_lane && is_slow && !is_standing(other);
    let length_m = ego.body.front_m + ego.body.rear_m;
    is_ahead.then(|| (lead_m + OVERTAKING_LENGTHS * length_m) / (user.wanted_mps - along_mps))
}

/// Whether the road is wide enough on one side of a vehicle on a stretch of the route \[m\].
fn has_road_beside(ego: &Agent, other: &Agent, across_m: f64, [from_m, to_m]: [f64; 2]) -> bool {
    let needed_m = 0.5 * other.body.width_m + ego.body.width_m;
    let [right_m, left_m] = [ego.route.right.extremes(from_m, to_m)[1], ego.route.left.extremes(from_m, to_m)[0]];
    left_m - across_m > needed_m || across_m - right_m > needed_m
}

/// Whether overtaking is forbidden somewhere on a stretch of a vehicle's route: at a light, or where another way crosses \[m\].
pub(super) fn is_forbidden(ego: &Agent, [from_m, to_m]: [f64; 2]) -> bool {
    let is_on = |along_m: f64| (from_m..to_m).contains(&along_m);
    let is_lit = ego.route.legs.iter().any(|leg| leg.light.is_some() && is_on(leg.to_m));
    is_lit || ego.route.crossings().any(|way| way.own_m[0] < to_m && way.own_m[1] > from_m)
}

/// Whether a vehicle is oncoming within a time.
fn comes_within(user: &Obliged<'_>, own_m: f64, other: &Agent, at: &FrenetPoint, time_s: f64) -> bool {
    let ego = &user.agent;
    let comes_mps = -other.state.speed_mps * libm::cos(other.state.heading_rad - at.heading_rad);
    let lead_m = at.along_m - own_m;
    let time_s = time_s + SPARE_S * ego.body.time_ratio();
    comes_mps > 0.0 && lead_m > 0.0 && lead_m < (user.wanted_mps + comes_mps) * time_s
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::fixture::real_car;
    use crate::{CentreLine, Profile, Route};

    /// The lane to the left ends at 60 m.
    #[test]
    fn there_is_road_beside_a_vehicle_only_where_the_other_lane_goes_on() {
        let edge = |to_m: f64| Profile::steps(&[[50.0, 5.25], [60.0, to_m]]).expect("a profile");
        let road = |left: Profile| {
            let right = Profile::constant(-1.75);
            Arc::new(Route::curved(CentreLine::straight(0.0), right, left, Profile::constant(1.75)))
        };
        let ego = Agent { route: road(edge(1.75)), ..real_car(0.0, 20.0) };
        let slow = real_car(30.0, 8.0);
        assert!(has_road_beside(&ego, &slow, 0.0, [0.0, 45.0]));
        assert!(!has_road_beside(&ego, &slow, 0.0, [0.0, 100.0]));
        let ego = Agent { route: road(edge(5.0)), ..ego };
        assert!(has_road_beside(&ego, &slow, 0.0, [0.0, 100.0]));
    }
}
