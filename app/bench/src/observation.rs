//! What a planner is given for each plan, as one JSON document. Its schema has a version; [`schema`] is the schema itself.
//!
//! It has what an observer sees: never plans, styles, families, seeds, routes or goals of others.

use std::collections::VecDeque;

use interplay_planners::road::network::{Lane, LaneUser, NeighbourRelation, RightOfWay};
use interplay_planners::scene::IndicatorSide;
use interplay_planners::{Limits, State};
use interplay_scenarios::{Scenario, VehicleClass};
use interplay_simulation::Simulation;
use schemars::JsonSchema;
use serde::Serialize;

/// The version of the schema.
pub const OBSERVATION_VERSION: &str = "EN1-observation-1";

/// Others within this distance are seen \[m\].
const RANGE_M: f64 = 150.0;
/// Length of the history \[s\].
const HISTORY_S: f64 = 1.0;
/// Distance of the points of lanes, and of the own route \[m\].
const SPACING_M: [f64; 2] = [5.0, 2.0];

/// What a planner is given. Lengths in m, speeds in m/s, angles in rad, the x axis to the east, headings counter-clockwise from it.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PlannerObservation {
    /// The version of the schema: `EN1-observation-1`.
    pub schema: &'static str,
    /// Time since the start \[s\].
    pub time_s: f64,
    /// Time until the next observation \[s\].
    pub period_s: f64,
    /// The own vehicle.
    pub own: OwnVehicle,
    /// Others and obstacles within 150 m.
    pub others: Vec<OtherVehicle>,
    /// All lanes of the road.
    pub lanes: Vec<SeenLane>,
    /// The own route.
    pub route: OwnRoute,
    /// The goal.
    pub goal: OwnGoal,
}

/// A pose with a speed.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Pose {
    /// Of the mass centre \[m\].
    pub x_m: f64,
    /// Of the mass centre \[m\].
    pub y_m: f64,
    /// Of the body \[rad\].
    pub heading_rad: f64,
    /// Of the mass centre \[m/s\].
    pub speed_mps: f64,
}

/// The own vehicle.
#[derive(Debug, Serialize, JsonSchema)]
pub struct OwnVehicle {
    /// Its pose.
    pub pose: Pose,
    /// The last applied acceleration \[m/s²\].
    pub acceleration_mps2: f64,
    /// The last applied steering angle \[rad\].
    pub steering_rad: f64,
    /// From the mass centre to the front bumper, the rear bumper, the front axle and the rear axle \[m\].
    pub reach_m: [f64; 4],
    /// Width of the body \[m\].
    pub width_m: f64,
    /// The bounds of the inputs and the speed.
    pub limits: Limits,
}

/// Another road user, or an obstacle.
#[derive(Debug, Serialize, JsonSchema)]
pub struct OtherVehicle {
    /// A number that stays the same during a start.
    pub id: usize,
    /// `car`, `van`, `truck`, `bus`, `bicycle`, `pedestrian` or `obstacle`.
    pub class: String,
    /// Its pose.
    pub pose: Pose,
    /// Change of its speed during the last tick \[m/s²\].
    pub acceleration_mps2: f64,
    /// From the mass centre to the front and the rear bumper \[m\].
    pub reach_m: [f64; 2],
    /// Width of the body \[m\].
    pub width_m: f64,
    /// `left`, `right`, or nothing.
    pub indicator: Option<&'static str>,
    /// Its poses during the last second, a tick of 0.1 s apart, the oldest first, the present one left out.
    pub history: Vec<Pose>,
}

/// A lane.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SeenLane {
    /// Its name.
    pub name: String,
    /// Points of its middle in driving direction \[m\].
    pub points: Vec<[f64; 2]>,
    /// Its width where it begins \[m\].
    pub width_m: f64,
    /// Its speed limit \[m/s\].
    pub speed_limit_mps: Option<f64>,
    /// The sign at its end: `priority`, `yield`, `stop` or `all-way-stop`. Where two yield, the one from the right goes first.
    pub right_of_way: RightOfWay,
    /// What the light at its end shows now.
    pub light: Option<interplay_planners::road::network::LightColour>,
    /// Whether it is a zebra crossing.
    pub is_zebra: bool,
    /// For whom it is; empty where it is for all.
    pub users: Vec<LaneUser>,
    /// Lanes that begin where it ends.
    pub successors: Vec<String>,
    /// The lane to its left, and whether that is driven in the opposite direction.
    pub left: Option<(String, bool)>,
    /// The same to its right.
    pub right: Option<(String, bool)>,
}

/// The own route from the vehicle on, for 150 m.
#[derive(Debug, Serialize, JsonSchema)]
pub struct OwnRoute {
    /// The lanes that it still follows.
    pub lanes: Vec<String>,
    /// Arc length of the vehicle along it \[m\].
    pub along_m: f64,
    /// Distance of the vehicle from its middle, positive to the left \[m\].
    pub across_m: f64,
    /// Points every 2 m: x, y and heading of the middle, the lateral positions of the right and the left edge of what may be driven on,
    /// and the speed limit (0 without one).
    pub points: Vec<[f64; 6]>,
}

/// The goal: the rear bumper is on the last lane of the route.
#[derive(Debug, Serialize, JsonSchema)]
pub struct OwnGoal {
    /// The last lane.
    pub lane: String,
    /// Way of the mass centre until the goal is reached \[m\].
    pub remaining_m: f64,
    /// The speed that the vehicle wants on a free road \[m/s\].
    pub wanted_speed_mps: f64,
}

/// The JSON Schema of [`PlannerObservation`].
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(PlannerObservation).to_value()
}

/// What is remembered of a run in order to observe it.
#[derive(Debug)]
pub(crate) struct Observer {
    lanes: Vec<(SeenLane, Option<std::sync::Arc<interplay_planners::road::network::LightCycle>>)>,
    /// States at the last ticks, the oldest first, the present ones last.
    past: VecDeque<Vec<State>>,
    most: usize,
}

impl Observer {
    pub fn new(scenario: &Scenario) -> Observer {
        let lanes = scenario.network.iter().flat_map(|network| network.lanes());
        let lanes = lanes.map(|lane| (seen_lane(lane), lane.light.clone())).collect();
        Observer { lanes, past: VecDeque::new(), most: (HISTORY_S / scenario.step_s).round() as usize + 1 }
    }

    /// Remembers the present states.
    pub fn watch(&mut self, world: &Simulation) {
        self.past.push_back(world.states());
        if self.past.len() > self.most {
            self.past.pop_front();
        }
    }

    /// What the ego sees now, after [`Observer::watch`].
    pub fn observation(&self, world: &Simulation) -> PlannerObservation {
        let (scenario, row) = (world.scenario(), world.scenario().ego_index());
        let states = self.past.back().cloned().unwrap_or_default();
        let vehicle = &scenario.vehicles[row];
        let body = vehicle.body;
        let input = world.frame().map_or_else(Default::default, |frame| frame.vehicles[row].input);
        let near = |other: &usize| {
            let [dx, dy] = [states[*other].x_m - states[row].x_m, states[*other].y_m - states[row].y_m];
            let is_absent = world.frame().is_some_and(|frame| frame.vehicles[*other].is_absent);
            *other != row && !is_absent && dx * dx + dy * dy < RANGE_M * RANGE_M
        };
        let others = (0..states.len()).filter(near).map(|other| self.other(world, other));
        let light_now = |(lane, light): &(SeenLane, Option<std::sync::Arc<_>>)| {
            let light: Option<&interplay_planners::road::network::LightCycle> = light.as_deref();
            SeenLane { light: light.map(|light| light.colour_at(world.time_s())), ..lane.clone() }
        };
        let (route, goal) = route_and_goal(scenario, &states[row]);
        PlannerObservation {
            schema: OBSERVATION_VERSION,
            time_s: world.time_s(),
            period_s: scenario.planning_period_s(),
            own: OwnVehicle {
                pose: pose(&states[row]),
                acceleration_mps2: input.acceleration_mps2,
                steering_rad: input.steering_rad,
                reach_m: [body.front_m, body.rear_m, body.front_axle_m, body.rear_axle_m],
                width_m: body.width_m,
                limits: vehicle.limits,
            },
            others: others.collect(),
            lanes: self.lanes.iter().map(light_now).collect(),
            route,
            goal,
        }
    }

    fn other(&self, world: &Simulation, row: usize) -> OtherVehicle {
        let vehicle = &world.scenario().vehicles[row];
        let poses: Vec<Pose> = self.past.iter().map(|states| pose(&states[row])).collect();
        let (now, history) = poses.split_last().map_or((pose(&vehicle.start), &[][..]), |(now, past)| (*now, past));
        let before_mps = history.last().map_or(now.speed_mps, |pose| pose.speed_mps);
        let indicator = world.frame().and_then(|frame| frame.vehicles[row].indicator);
        OtherVehicle {
            id: row,
            class: if vehicle.obstacle.is_some() { "obstacle".to_owned() } else { class_word(vehicle.class) },
            pose: now,
            acceleration_mps2: (now.speed_mps - before_mps) / world.scenario().step_s,
            reach_m: [vehicle.body.front_m, vehicle.body.rear_m],
            width_m: vehicle.body.width_m,
            indicator: indicator.map(|side| if side == IndicatorSide::Left { "left" } else { "right" }),
            history: history.to_vec(),
        }
    }
}

fn pose(state: &State) -> Pose {
    let State { x_m, y_m, heading_rad, speed_mps } = *state;
    Pose { x_m, y_m, heading_rad, speed_mps }
}

fn class_word(class: Option<VehicleClass>) -> String {
    let word = serde_json::to_value(class.unwrap_or(VehicleClass::Car)).ok();
    word.and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default()
}

fn seen_lane(lane: &Lane) -> SeenLane {
    let count = (lane.centre.length_m() / SPACING_M[0]).ceil().max(1.0) as usize;
    let at = |point: usize| lane.centre.position(lane.centre.length_m() * point as f64 / count as f64, 0.0);
    let beside = |neighbour: &Option<interplay_planners::road::network::LaneNeighbour>| {
        neighbour.as_ref().map(|beside| (beside.lane.clone(), beside.relation == NeighbourRelation::Oncoming))
    };
    SeenLane {
        name: lane.name.clone(),
        points: (0..=count).map(at).collect(),
        width_m: lane.width.value(0.0),
        speed_limit_mps: lane.speed_limit_mps,
        right_of_way: lane.right_of_way,
        light: None,
        is_zebra: lane.is_zebra,
        users: lane.users.clone(),
        successors: lane.successors.clone(),
        left: beside(&lane.left),
        right: beside(&lane.right),
    }
}

fn route_and_goal(scenario: &Scenario, state: &State) -> (OwnRoute, OwnGoal) {
    let vehicle = &scenario.vehicles[scenario.ego_index()];
    let route = &vehicle.route;
    let place = route.locate(state.position(), None);
    let ahead = |step: usize| place.along_m + SPACING_M[1] * step as f64;
    let point = |along_m: f64| {
        let [x_m, y_m] = route.position(along_m, 0.0);
        let limit_mps = route.leg(along_m).and_then(|leg| leg.speed_limit_mps).unwrap_or_default();
        let edges_m = [route.right.value(along_m), route.left.value(along_m)];
        [x_m, y_m, route.centre.at(along_m).heading_rad, edges_m[0], edges_m[1], limit_mps]
    };
    let end_m = route.end_m().min(place.along_m + RANGE_M);
    let legs = route.legs.iter().filter(|leg| leg.to_m > place.along_m);
    let last = route.legs.last();
    let own = OwnRoute {
        lanes: legs.map(|leg| leg.lane.clone()).collect(),
        along_m: place.along_m,
        across_m: place.across_m,
        points: (0..).map(ahead).take_while(|along_m| *along_m <= end_m).map(point).collect(),
    };
    let goal = OwnGoal {
        lane: last.map(|leg| leg.lane.clone()).unwrap_or_default(),
        remaining_m: last.map_or(0.0, |leg| leg.from_m + vehicle.body.rear_m - place.along_m).max(0.0),
        wanted_speed_mps: vehicle.goal.speed_mps.unwrap_or(vehicle.start.speed_mps),
    };
    (own, goal)
}
