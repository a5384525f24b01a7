//! Positions of vehicles that drive along lanes: their state at the start, and the lanes ahead.

use interplay_planners::drivers::recorded::Record;
use interplay_planners::road::network::{Lane, RoadNetwork};
use interplay_planners::{Body, Route, State};

use super::super::model::{PlanningProblem, Region};
use super::vehicles::rounded;
use crate::resolve::placement::way_of_record;

/// Cosine of the largest angle between a start and its lane.
const MIN_COS_OF_START: f64 = 0.5;
/// The shifts towards the middle of the lane that are tried until the body of a vehicle is on the road, as shares.
const SHARES: [f64; 5] = [1.0, 0.75, 0.5, 0.25, 0.0];
/// The most lanes near a vehicle on which a placement is tried.
const MAX_NEAR_LANES: usize = 20;
/// The most lanes of a route without a goal.
const MAX_LANES: usize = 100;

/// A vehicle at its start, with the lanes ahead.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OnLanes {
    pub state: State,
    pub lanes: Vec<String>,
    /// The distance by which it was moved to be on the road \[m\].
    pub moved_m: f64,
    /// The angle by which it was turned for that \[rad\].
    pub turned_rad: f64,
}

/// The shift of a full-size vehicle that counts as much as a turn by one radian \[m\].
const METRES_PER_RAD: f64 = 4.0;

impl OnLanes {
    /// The difference between this state and the original one \[m\].
    pub(super) fn change_m(&self) -> f64 {
        self.moved_m + METRES_PER_RAD * self.turned_rad
    }
}

/// The lanes on which a vehicle may be, those in its direction first.
pub(super) fn lanes_at<'a>(network: &'a RoadNetwork, state: &State) -> Vec<&'a Lane> {
    let places = network.locate(state.position(), state.heading_rad).into_iter();
    let along = places.filter(|place| libm::cos(place.heading_error_rad) >= MIN_COS_OF_START);
    along.filter_map(|place| network.lane(&place.lane)).collect()
}

/// The lanes near a vehicle that is on none, each with the state in the middle of it: those in its direction first, then by distance.
pub(super) fn near<'a>(network: &'a RoadNetwork, state: &State, away_m: f64) -> Vec<(&'a Lane, State)> {
    let beside = network.lanes().iter().map(|lane| {
        let at = lane.centre.project(state.position(), None);
        let length_m = lane.centre.length_m();
        let along_m = at.along_m.clamp(0.01 * length_m, 0.99 * length_m);
        let [x_m, y_m] = lane.centre.position(along_m, 0.0);
        let heading_rad = lane.centre.at(along_m).heading_rad;
        let distance_m = libm::hypot(x_m - state.x_m, y_m - state.y_m);
        let is_against = libm::cos(heading_rad - state.heading_rad) < MIN_COS_OF_START;
        (lane, State { x_m, y_m, heading_rad, ..*state }, (is_against, distance_m))
    });
    let mut near: Vec<_> = beside.filter(|(_, _, (_, distance_m))| *distance_m <= away_m).collect();
    near.sort_by(|(_, _, one), (_, _, other)| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
    near.into_iter().map(|(lane, state, _)| (lane, state)).take(MAX_NEAR_LANES).collect()
}

/// The lanes straight on from a lane: of several successors, the one that turns least.
pub(super) fn straight_on(network: &RoadNetwork, lane: &Lane) -> Vec<String> {
    let mut names = vec![lane.name.clone()];
    let mut last = lane;
    while names.len() < MAX_LANES {
        let ahead = last.successors.iter().filter_map(|name| network.lane(name));
        let turn = |lane: &Lane| {
            let headings = [0.0, lane.centre.length_m()].map(|along_m| lane.centre.at(along_m).heading_rad);
            (headings[1] - headings[0]).abs()
        };
        let next = ahead.filter(|lane| !names.contains(&lane.name)).min_by(|a, b| turn(a).total_cmp(&turn(b)));
        let Some(next) = next else { break };
        names.push(next.name.clone());
        last = next;
    }
    names
}

/// The longest leading part of some lanes along which a body can drive; `None` if it does not fit on the first lane.
pub(super) fn on(network: &RoadNetwork, lanes: Vec<String>, state: &State, body: &Body) -> Option<OnLanes> {
    let mut lanes = lanes;
    while !lanes.is_empty() {
        if let Some(found) = network.route(&lanes).ok().and_then(|route| placed(network, &route, &lanes, state, body)) {
            return Some(found);
        }
        lanes.pop();
    }
    None
}

/// A body on a route, moved towards its middle as far as necessary.
fn placed(network: &RoadNetwork, route: &Route, lanes: &[String], state: &State, body: &Body) -> Option<OnLanes> {
    route.check_turns(TURNING_RADIUS_M).ok()?;
    let at = route.locate(state.position(), None);
    let error_rad = libm::remainder(state.heading_rad - at.heading_rad, std::f64::consts::TAU);
    let shares = SHARES.iter().map(|share| {
        let [x_m, y_m] = route.position(at.along_m, share * at.across_m);
        let heading_rad = (at.heading_rad + share * error_rad).to_degrees();
        // The values are rounded as in the file, so that the check sees what is read back.
        let [x_m, y_m] = [x_m, y_m].map(|coordinate| rounded(coordinate, 4));
        State { x_m, y_m, heading_rad: rounded(heading_rad, 4).to_radians(), ..*state }
    });
    let fits = |placed: &State| {
        let is_on_first = lanes_at(network, placed).iter().any(|lane| Some(&lane.name) == lanes.first());
        is_on_first && route.contains(body, placed, 0.0)
    };
    let placed = shares.into_iter().find(fits)?;
    let moved_m = libm::hypot(placed.x_m - state.x_m, placed.y_m - state.y_m);
    let turned_rad = libm::remainder(placed.heading_rad - state.heading_rad, std::f64::consts::TAU).abs();
    Some(OnLanes { state: placed, lanes: lanes.to_vec(), moved_m, turned_rad })
}

/// The smallest radius of a lane that routes use \[m\].
const TURNING_RADIUS_M: f64 = 5.0;

/// The lanes that a record follows, from a lane on.
pub(super) fn along_record(network: &RoadNetwork, rows: &[[f64; 5]], lane: &Lane) -> Vec<String> {
    Record::new(rows).map_or_else(|_| vec![lane.name.clone()], |record| way_of_record(&record, lane, network))
}

/// The acceleration with which the ego reaches its desired speed \[m/s²\].
const ACCELERATION_MPS2: f64 = 1.5;
/// The highest speed of a car \[m/s\].
const MAX_SPEED_MPS: f64 = 50.0;
/// The number of bisections of the range of speeds: to less than 0.1 mm/s.
const HALVINGS: usize = 20;

/// The desired speed that reaches the goal in the middle of its time; `None` for a goal without position or time \[m/s\].
pub(super) fn wanted_mps(
    problem: &PlanningProblem<'_>,
    step_s: f64,
    network: &RoadNetwork,
    lanes: &[String],
    start: &State,
) -> Option<f64> {
    let goal = problem.goals.first()?;
    let [from, to] = goal.time?;
    let middle = goal.position.iter().find_map(Region::middle)?;
    let route = network.route(lanes).ok()?;
    let distance_m = route.along(middle) - route.along(start.position());
    let time_s = (0.5 * (from + to) - problem.initial.time) * step_s;
    (distance_m > 0.0 && time_s > 0.0).then(|| speed_mps(distance_m, time_s, start.speed_mps))
}

/// The speed that covers a distance in a time, if it is reached at a constant acceleration and then kept \[m/s\].
fn speed_mps(distance_m: f64, time_s: f64, own_mps: f64) -> f64 {
    let covered_m = |wanted_mps: f64| {
        let changing_s = ((wanted_mps - own_mps).abs() / ACCELERATION_MPS2).min(time_s);
        let reached_mps = own_mps + (wanted_mps - own_mps).signum() * ACCELERATION_MPS2 * changing_s;
        0.5 * (own_mps + reached_mps) * changing_s + reached_mps * (time_s - changing_s)
    };
    let (mut low_mps, mut high_mps) = (0.0, MAX_SPEED_MPS);
    for _ in 0..HALVINGS {
        let middle_mps = 0.5 * (low_mps + high_mps);
        if covered_m(middle_mps) < distance_m {
            low_mps = middle_mps;
        } else {
            high_mps = middle_mps;
        }
    }
    // If no speed is high enough, the acceleration limit is too low; the final speed of a constant acceleration is then the best choice.
    (0.5 * (low_mps + high_mps)).min((2.0 * distance_m / time_s - own_mps).max(own_mps))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arrival_speed_covers_the_distance_in_time() {
        assert!((speed_mps(100.0, 10.0, 10.0) - 10.0).abs() < 1e-3, "as it drives");
        // 10 m/s to 13 m/s takes 2 s and 23 m, and 8 s more are 104 m.
        assert!((speed_mps(127.0, 10.0, 10.0) - 13.0).abs() < 1e-3);
        // 10 m/s to 7 m/s takes 2 s and 17 m.
        assert!((speed_mps(17.0 + 56.0, 10.0, 10.0) - 7.0).abs() < 1e-3);
        assert!(speed_mps(1e4, 1.0, 10.0) <= 2e4, "never reached, and still a number");
    }
}
