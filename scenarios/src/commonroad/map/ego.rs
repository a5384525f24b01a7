//! The ego of a planning problem.

use interplay_planners::road::network::{Lane, LaneUser, RoadNetwork};
use interplay_planners::{Body, State};

use super::super::model::{CommonRoad, PlanningProblem, Region};
use super::lanes::Lanes;
use super::notes::{NOT_YET, Notes};
use super::places::{self, OnLanes};
use super::vehicles::{in_world, rounded};
use crate::format::stated::Stated;
use crate::format::vehicle_config::VehicleConfig;
use crate::model::classes::VehicleClass;
use crate::model::traffic::goal::GoalConfig;
use crate::text::name::EGO;

/// A vehicle that is slower than this at the start wants to drive at the speed limit \[m/s\].
const MIN_WANTED_MPS: f64 = 3.0;
/// The desired speed if the file states none: 30 km/h \[m/s\].
const USUAL_MPS: f64 = 8.33;
/// The largest acceleration with which the ego begins \[m/s²\].
const MAX_ACCELERATION_MPS2: f64 = 10.0;
/// The highest speed of a car \[m/s\].
const MAX_SPEED_MPS: f64 = 50.0;
/// The smallest shift of a start that is noted \[m\].
const NOTED_MOVE_M: f64 = 0.01;
/// A planning problem that starts farther than this from every lane is left out \[m\].
const MAX_AWAY_M: f64 = 50.0;

/// The ego of a planning problem is a BMW 320i, the car of CommonRoad's referee: 4.508 m × 1.61 m, and its axles \[m\].
const BMW_320I: Body = Body {
    front_m: 2.254,
    rear_m: 2.254,
    width_m: 1.61,
    front_axle_m: 1.1562,
    rear_axle_m: 1.4227,
    scale: Body::REAL_SCALE,
};

/// Its largest steering rate \[rad/s\].
const STEERING_RATE_RADPS: f64 = 0.4;

pub(super) struct Ego {
    pub config: VehicleConfig,
    pub state: State,
    pub body: Body,
}

/// The ego of a planning problem; `None` if it is far from every lane, or if no car can drive along a lane from there.
pub(super) fn of_problem(problem: &PlanningProblem<'_>, step_s: f64, lanes: &Lanes, notes: &mut Notes) -> Option<Ego> {
    let initial = &problem.initial;
    let speed_mps = initial.velocity_mps.clamp(0.0, MAX_SPEED_MPS);
    if speed_mps != initial.velocity_mps {
        notes.one(["initial speed", "initial speeds"], "carried over within the limits of a car");
    }
    let [x_m, y_m] = initial.position;
    let state = State { x_m, y_m, heading_rad: initial.orientation_rad, speed_mps };
    let network = &lanes.network.open_to(LaneUser::Car);
    let goals = goal_lanes(problem, network, lanes);
    let near = places::near(network, &state, MAX_AWAY_M);
    if near.is_empty() {
        let what = ["planning problem far from every lane", "planning problems far from every lane"];
        notes.one(what, "left out");
        return None;
    }
    let on_lanes = places::lanes_at(network, &state);
    let found = way(network, &on_lanes, &goals, &state).or_else(|| {
        let found = near.iter().find_map(|(lane, beside)| way(network, &[*lane], &goals, beside))?;
        notes.one(["initial state beside the lanes", "initial states beside the lanes"], "moved onto the nearest lane");
        Some(found)
    });
    let Some((OnLanes { state, lanes: route, moved_m, .. }, reaches_goal)) = found else {
        let what = ["planning problem without room for a car", "planning problems without room for a car"];
        notes.one(what, "left out");
        return None;
    };
    if !reaches_goal && !problem.goals.is_empty() {
        let fate = if goals.is_empty() {
            "the ego drives straight on"
        } else {
            "not reached by lanes: the ego drives straight on"
        };
        notes.one(["goal without a lane", "goals without a lane"], fate);
    }
    let is_cut_short = !reaches_goal && is_cut_short(&route, lanes, notes);
    if moved_m > NOTED_MOVE_M {
        notes.one(["start of the ego", "starts of the ego"], "moved, so that its body is on its lane");
    }
    let limit_mps = route.first().and_then(|lane| network.lane(lane)).and_then(|lane| lane.speed_limit_mps);
    let in_time_mps = places::wanted_mps(problem, step_s, network, &route, &state).filter(|_| reaches_goal);
    let wanted_mps = rounded(wanted_mps(problem, speed_mps, in_time_mps, limit_mps, notes), 2);
    note_goals(problem, notes);
    let goal = GoalConfig { speed_mps: Some(wanted_mps), ..GoalConfig::default() };
    let mut ego = Ego::new(state, route, goal);
    ego.config.stops_at_end = is_cut_short.then_some(true);
    let stated =
        problem.acceleration_mps2.map(|stated| rounded(stated.clamp(-MAX_ACCELERATION_MPS2, MAX_ACCELERATION_MPS2), 3));
    ego.config.start.acceleration_mps2 = stated.filter(|stated| *stated != 0.0);
    Some(ego)
}

/// Whether a route ends although the map goes on, which is noted.
fn is_cut_short(route: &[String], lanes: &Lanes, notes: &mut Notes) -> bool {
    let is_cut_short = route.last().is_some_and(|last| lanes.followed.contains(last));
    if is_cut_short {
        let fate = "ends where the next lane turns too tightly or begins in another direction: the ego stops there";
        notes.one(["route without a goal", "routes without a goal"], fate);
    }
    is_cut_short
}

/// The route of a car from one of some lanes to one of the goals, and whether one exists; straight on otherwise.
fn way(network: &RoadNetwork, starts: &[&Lane], goals: &[String], state: &State) -> Option<(OnLanes, bool)> {
    let body = &BMW_320I;
    // Where lanes overlap, choose the route that fits the state best, and among equal ones the shortest list of lanes.
    let pairs = starts.iter().flat_map(|lane| goals.iter().map(move |goal| (lane, goal)));
    let ways = pairs.filter_map(|(lane, goal)| to_lane(network, lane, goal, state, body));
    let is_better = |one: &OnLanes, other: &OnLanes| {
        let by_change = rounded(one.change_m(), 2).total_cmp(&rounded(other.change_m(), 2));
        by_change.then(one.lanes.len().cmp(&other.lanes.len()))
    };
    let to_goal = ways.min_by(is_better);
    let straight_on =
        || starts.iter().find_map(|lane| places::on(network, places::straight_on(network, lane), state, body));
    to_goal.map(|way| (way, true)).or_else(|| straight_on().map(|way| (way, false)))
}

impl Ego {
    fn new(state: State, route: Vec<String>, goal: GoalConfig) -> Ego {
        let class = Some(VehicleClass::Car);
        let body = BMW_320I;
        let stated = Stated::default().with("front_m", body.front_m).with("rear_m", body.rear_m);
        let stated = stated.with("width_m", body.width_m).with("front_axle_m", body.front_axle_m);
        let stated = Some(stated.with("rear_axle_m", body.rear_axle_m));
        let limits = Some(Stated::default().with("steering_rate_max_radps", STEERING_RATE_RADPS));
        let config =
            VehicleConfig { class, body: stated, limits, goal, route, ..VehicleConfig::new(EGO, in_world(&state)) };
        Ego { config, state, body }
    }
}

/// The ego of a map without a planning problem and without vehicles: at the start of the longest lane.
pub(super) fn on_longest_lane(lanes: &Lanes, notes: &mut Notes) -> Option<Ego> {
    let network = &lanes.network.open_to(LaneUser::Car);
    let body = VehicleClass::Car.dimensions().body;
    let mut by_length: Vec<_> = network.lanes().iter().collect();
    by_length.sort_by(|a, b| b.centre.length_m().total_cmp(&a.centre.length_m()));
    let found = by_length.iter().find_map(|lane| {
        let along_m = (2.0 * body.rear_m).min(0.5 * lane.centre.length_m());
        let [x_m, y_m] = lane.centre.position(along_m, 0.0);
        let heading_rad = lane.centre.at(along_m).heading_rad;
        let state =
            State { x_m, y_m, heading_rad, speed_mps: lane.speed_limit_mps.unwrap_or(USUAL_MPS).min(USUAL_MPS) };
        places::on(network, places::straight_on(network, lane), &state, &body)
    });
    let OnLanes { state, lanes: route, .. } = found?;
    notes.one(["map without vehicles", "maps without vehicles"], "the ego starts where the longest lane begins");
    let stops_at_end = is_cut_short(&route, lanes, notes).then_some(true);
    let class = Some(VehicleClass::Car);
    let config = VehicleConfig { class, route, stops_at_end, ..VehicleConfig::new(EGO, in_world(&state)) };
    Some(Ego { config, state, body })
}

/// The shortest route from a lane to another, with a car at its start.
fn to_lane(network: &RoadNetwork, from: &Lane, goal: &str, state: &State, body: &Body) -> Option<OnLanes> {
    let route = network.shortest_route(&from.name, goal).ok()?;
    let names: Vec<String> = route.legs.iter().map(|leg| leg.lane.clone()).collect();
    let count = names.len();
    places::on(network, names, state, body).filter(|found| found.lanes.len() == count)
}

/// The names of the lanes for cars that are goals, or in which goals lie.
fn goal_lanes(problem: &PlanningProblem<'_>, network: &RoadNetwork, lanes: &Lanes) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for goal in &problem.goals {
        let heading_rad = goal.orientation_rad.map_or(problem.initial.orientation_rad, |[from, to]| 0.5 * (from + to));
        for region in &goal.position {
            match (region, region.middle()) {
                (Region::Lanelets(ids), _) => found.extend(ids.iter().filter_map(|id| lanes.names.get(id)).cloned()),
                (_, Some(middle)) => {
                    let places = network.locate(middle, heading_rad);
                    found.extend(places.into_iter().map(|place| place.lane));
                }
                (_, None) => {}
            }
        }
    }
    found
}

/// The desired speed of the ego: one that reaches the goal in time, or that of its goal, or its own, or the speed limit \[m/s\].
fn wanted_mps(
    problem: &PlanningProblem<'_>,
    own_mps: f64,
    in_time_mps: Option<f64>,
    limit_mps: Option<f64>,
    notes: &mut Notes,
) -> f64 {
    let stated = problem.goals.iter().find_map(|goal| goal.velocity_mps);
    if let Some(in_time_mps) = in_time_mps.filter(|speed_mps| *speed_mps >= MIN_WANTED_MPS) {
        let [from_mps, to_mps] = stated.unwrap_or([0.0, MAX_SPEED_MPS]);
        return in_time_mps.max(from_mps).min(to_mps).clamp(0.0, MAX_SPEED_MPS);
    }
    if let Some([from_mps, to_mps]) = stated {
        let nearest_mps = own_mps.max(from_mps.max(0.0)).min(to_mps.max(0.0));
        let wanted_mps = if nearest_mps < MIN_WANTED_MPS { 0.5 * (from_mps + to_mps) } else { nearest_mps };
        return wanted_mps.clamp(0.0, MAX_SPEED_MPS);
    }
    if own_mps >= MIN_WANTED_MPS {
        return own_mps;
    }
    notes.one(["goal without a speed", "goals without a speed"], "the ego drives as fast as is permitted, or 30 km/h");
    limit_mps.unwrap_or(USUAL_MPS).min(MAX_SPEED_MPS)
}

/// Notes the parts of goals that a scenario cannot state.
fn note_goals(problem: &PlanningProblem<'_>, notes: &mut Notes) {
    notes.several(problem.goals.len().saturating_sub(1), ["further goal", "further goals"], NOT_YET);
    for goal in &problem.goals {
        if goal.time.is_some() {
            notes.one(["time of a goal", "times of goals"], "carried over as the duration of the run only");
        }
        if goal.orientation_rad.is_some() {
            notes.one(["heading of a goal", "headings of goals"], NOT_YET);
        }
        let is_part = |region: &&Region| !matches!(region, Region::Lanelets(_));
        let parts = goal.position.iter().filter(is_part).count();
        notes.several(parts, ["region of a goal", "regions of goals"], "carried over as the lane in which it lies");
    }
}

/// The time step at which the run begins: that of the planning problem, or the first of any vehicle.
pub(in super::super) fn begin(scenario: &CommonRoad<'_>) -> f64 {
    let of_problem = scenario.problems.first().map(|problem| problem.initial.time);
    let of_vehicles = scenario.obstacles.iter().filter_map(|obstacle| obstacle.states.first()).map(|state| state.time);
    of_problem.unwrap_or_else(|| of_vehicles.min_by(f64::total_cmp).unwrap_or_default())
}

/// The last time step of the goals of the first planning problem, or else of the records.
pub(super) fn end(scenario: &CommonRoad<'_>) -> f64 {
    let goals = scenario.problems.first().into_iter().flat_map(|problem| &problem.goals);
    let of_goals = goals.filter_map(|goal| goal.time).map(|[_, to]| to).max_by(f64::total_cmp);
    let of_vehicles = scenario.obstacles.iter().filter_map(|obstacle| obstacle.states.last()).map(|state| state.time);
    of_goals.unwrap_or_else(|| of_vehicles.max_by(f64::total_cmp).unwrap_or_default())
}
