//! Vehicles together on a road, with the bicycle as the plant: the recommended settings of every family of scenarios.
#![allow(dead_code, reason = "each binary uses its own part")]

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;
use std::time::Instant;

use interplay_planners::drivers::human::{self, Style};
use interplay_planners::drivers::{bayesian, conservative, cooperative, game, negotiation};
use interplay_planners::perception::belief;
use interplay_planners::perception::sensing::Sensor;
use interplay_planners::prediction::{constant_velocity, steadily_along};
use interplay_planners::traffic::{Decision, RoadUser, Traffic};
use interplay_planners::{
    Agent, Body, Corridor, Driver, Goal, Input, LaneEnd, Limits, Plan, PlanError, Planner, Route, SafetyEllipse, State,
};

/// Two lanes along x.
const ROAD: Corridor = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end: None };

pub const STEP_S: f64 = 0.1;
pub const HORIZON: usize = 30;
/// Centres of the two lanes \[m\].
pub const LANES: [f64; 2] = [0.185, 0.555];

pub struct Vehicle {
    pub agent: Agent,
    pub goal: Goal,
    pub driver: Driver,
}

#[derive(Default)]
pub struct Run {
    /// Names, in the order of the vehicles.
    pub names: Vec<String>,
    /// Per tick, the states of all vehicles; the first are the starts.
    pub states: Vec<Vec<State>>,
    pub plans: Vec<Plan>,
    /// How long they took \[ms\].
    pub plan_ms: Vec<f64>,
    /// Plans that were not found, of any vehicle.
    pub failures: Vec<(usize, String, PlanError)>,
    /// Smallest distance between vehicle 0's safety ellipse centre and another, in half axes.
    pub nearest: f64,
    /// When footprints first overlapped, and whose.
    pub collision: Option<(usize, String, String)>,
}

/// A vehicle on a two-lane road along x.
pub fn vehicle(
    name: &str,
    [x_m, y_m, speed_mps]: [f64; 3],
    wants: [f64; 2],
    tracking: [f64; 4],
    driver: Driver,
) -> Vehicle {
    let state = State { x_m, y_m, heading_rad: 0.0, speed_mps };
    let agent = Agent {
        name: name.to_owned(),
        state,
        previous_input: Input::default(),
        body: Body::default(),
        limits: Limits::default(),
        route: ROAD.into(),
        prediction: constant_velocity(&state, HORIZON, STEP_S).into(),
        shared_goal: None,
        can_be_asked: true,
        is_obstacle: false,
        indicator: None,
        rules: interplay_planners::rules::RoadRules::default(),
        urgency: 1.0,
        own_place: Default::default(),
    };
    let target = State { x_m: 0.0, y_m: wants[0], heading_rad: 0.0, speed_mps: wants[1] };
    let goal = Goal { target, tracking, comfort: [0.1, 0.1], safety: SafetyEllipse::default() };
    Vehicle { agent, goal, driver }
}

pub fn human(style: Style) -> Driver {
    Driver::Human(human::Settings { style: Some(style), ..human::Settings::default() })
}

/// The ego changes into a lane in which two faster humans come up. The gap between them is too small for it unless one of them
/// yields; a larger one it can open by moving half into the lane, as then even tough drivers have a car ahead to follow.
pub fn lane_change(ego: Driver, [front, rear]: [Style; 2]) -> Vec<Vehicle> {
    let (steady, wants) = ([0.0, 4.0, 1.0, 1.0], [LANES[1], 1.4]);
    vec![
        vehicle("ego", [0.0, LANES[0], 1.0], [LANES[1], 1.0], [0.0, 1.0, 0.5, 1.0], ego),
        vehicle("front", [-0.4, LANES[1], 1.4], wants, steady, human(front)),
        vehicle("rear", [-1.6, LANES[1], 1.4], wants, steady, human(rear)),
    ]
}

/// The same from a lane that ends.
pub fn ramp_merge(ego: Driver, styles: [Style; 2]) -> Vec<Vehicle> {
    let mut vehicles = lane_change(ego, styles);
    let end = Some(LaneEnd { end_m: 3.5, height_m: 0.37, taper_m: 0.3 });
    vehicles[0].agent.route = Corridor { end, ..ROAD }.into();
    vehicles
}

/// A human merges into the ego's lane ahead of it.
pub fn lane_keeping(ego: Driver, merger: Style) -> Vec<Vehicle> {
    vec![
        vehicle("ego", [0.0, LANES[1], 1.0], [LANES[1], 1.3], [0.0, 4.0, 1.0, 1.0], ego),
        vehicle("merger", [0.65, LANES[0], 1.0], [LANES[1], 1.0], [0.0, 0.3, 0.5, 1.0], human(merger)),
    ]
}

/// A human crosses the ego's path from the right, where it starts `away_m` before the ego's road.
pub fn intersection(ego: Driver, crossing: Style, away_m: f64) -> Vec<Vehicle> {
    let mut ego = vehicle("ego", [-2.5, LANES[0], 0.7], [LANES[0], 1.2], [0.0, 4.0, 1.0, 1.0], ego);
    ego.agent.route = Corridor { left_m: 0.37, ..ROAD }.into();
    ego.goal.safety.across_m = 0.5;
    let mut human = vehicle("crossing", [0.0, -away_m, 0.8], [0.0, 0.8], [0.0, 4.0, 1.0, 1.0], human(crossing));
    human.agent.route = Corridor { heading_rad: FRAC_PI_2, right_m: -0.185, left_m: 0.185, end: None }.into();
    human.agent.state.heading_rad = FRAC_PI_2;
    human.agent.prediction = constant_velocity(&human.agent.state, HORIZON, STEP_S).into();
    human.goal.target.heading_rad = FRAC_PI_2;
    vec![ego, human]
}

/// Places vehicles of a straight road at the same Frenet coordinates of another one that is as wide, and begins 3 m earlier.
pub fn moved_to(route: &Arc<Route>, mut vehicles: Vec<Vehicle>) -> Vec<Vehicle> {
    for vehicle in &mut vehicles {
        let agent = &mut vehicle.agent;
        agent.route = Arc::clone(route);
        let place = |state: State| {
            let [x_m, y_m] = route.position(state.x_m + 3.0, state.y_m);
            let heading_rad = state.heading_rad + route.centre.at(state.x_m + 3.0).heading_rad;
            State { x_m, y_m, heading_rad, ..state }
        };
        agent.state = place(agent.state);
        vehicle.goal.target = place(vehicle.goal.target);
        let steps = agent.prediction.horizon();
        agent.prediction = steadily_along(route, &agent.body, &agent.state, steps, STEP_S).into();
    }
    vehicles
}

/// A family of scenarios: its name, and its vehicles for an ego's driver.
pub type Family = (String, Box<dyn Fn(Driver) -> Vec<Vehicle>>);

/// Every family with its drivers: lane changes and ramp merges with two humans, lane keeping and intersections with one.
pub fn families() -> Vec<Family> {
    let pairs = [
        ("nice-nice", [Style::Nice, Style::Nice]),
        ("tough-nice", [Style::Tough, Style::Nice]),
        ("tough-tough", [Style::Tough, Style::Tough]),
    ];
    let mut found: Vec<Family> = Vec::new();
    for (styles, pair) in pairs {
        found.push((format!("lane-change/{styles}"), Box::new(move |ego| lane_change(ego, pair))));
        found.push((format!("ramp-merge/{styles}"), Box::new(move |ego| ramp_merge(ego, pair))));
    }
    for (name, style, away_m) in [("nice", Style::Nice, 1.9), ("tough", Style::Tough, 1.75)] {
        found.push((format!("lane-keeping/{name}"), Box::new(move |ego| lane_keeping(ego, style))));
        found.push((format!("intersection/{name}"), Box::new(move |ego| intersection(ego, style, away_m))));
    }
    found
}

/// The planners of an ego, with their default settings.
pub fn egos() -> [Driver; 5] {
    [
        Driver::Conservative(conservative::Settings::default()),
        Driver::Negotiation(negotiation::Settings::default()),
        Driver::Bayesian(bayesian::Settings::default()),
        Driver::Game(game::Settings::default()),
        Driver::Cooperative(cooperative::Settings::default()),
    ]
}

/// The vehicles as road users that have not planned yet, and their planners.
pub fn begin(vehicles: &[Vehicle]) -> (Traffic, Vec<Planner>) {
    let road_user = |Vehicle { agent, goal, driver }: &Vehicle| {
        let agent =
            Agent { shared_goal: driver.shared_goal(goal), can_be_asked: driver.can_be_asked(), ..agent.clone() };
        RoadUser { knows_plans: driver.knows_plans(), ..RoadUser::new(agent, *goal, driver.goes_first()) }
    };
    let road_users = vehicles.iter().map(road_user).collect();
    let planners = vehicles.iter().map(|vehicle| vehicle.driver.planner()).collect();
    (Traffic { step_s: STEP_S, horizon: HORIZON, road_users, ..Traffic::default() }, planners)
}

/// Drives the vehicles through the loop of the application, with the bicycle as the plant.
pub fn run(vehicles: Vec<Vehicle>, ticks: usize) -> Run {
    run_inferring(vehicles, ticks, &belief::Settings::default(), None)
}

/// The same with settings for how planners infer plans, and a sensor of vehicle 0.
pub fn run_inferring(
    vehicles: Vec<Vehicle>,
    ticks: usize,
    inference: &belief::Settings,
    mut sensor: Option<Sensor>,
) -> Run {
    let (mut traffic, _) = begin(&vehicles);
    let mut planners: Vec<Planner> =
        vehicles.iter().map(|vehicle| vehicle.driver.planner_believing(inference)).collect();
    let names = vehicles.iter().map(|vehicle| vehicle.agent.name.clone()).collect();
    let mut run = Run { names, states: vec![states(&traffic)], nearest: f64::INFINITY, ..Run::default() };
    for tick in 0..ticks {
        let decisions = traffic.drive(|index, scene| {
            let sensed = sensor.as_mut().filter(|_| index == 0).map(|sensor| sensor.sense(scene));
            let began = Instant::now();
            let outcome = match &sensed {
                Some(sensed) => planners[index].plan_sensed(sensed),
                None => planners[index].plan(scene),
            };
            if index == 0 {
                run.plan_ms.push(1e3 * began.elapsed().as_secs_f64());
            }
            outcome
        });
        run.note_decisions(decisions, tick);
        run.states.push(states(&traffic));
        run.note_distances(&traffic, tick);
    }
    run
}

fn states(traffic: &Traffic) -> Vec<State> {
    traffic.road_users.iter().map(|user| user.agent.state).collect()
}

impl Vehicle {
    pub fn drive(&mut self, driver: Driver) {
        self.driver = driver;
    }
}

impl Run {
    fn note_decisions(&mut self, decisions: Vec<Decision>, tick: usize) {
        for Decision { vehicle, plan, failure, .. } in decisions {
            match failure {
                Some(error) => self.failures.push((tick, self.names[vehicle].clone(), error)),
                None if vehicle == 0 => self.plans.push(Arc::unwrap_or_clone(plan)),
                None => {}
            }
        }
    }

    fn note_distances(&mut self, traffic: &Traffic, tick: usize) {
        let users = &traffic.road_users;
        let ego = &users[0];
        for (i, other) in users.iter().enumerate().skip(1) {
            let at = other.agent.state.position();
            let heading = other.agent.route.heading_at(at);
            let distance = ego.goal.safety.oriented(heading).distance(ego.agent.state.position(), at);
            self.nearest = self.nearest.min(distance.squared.sqrt());
            for earlier in &users[..i] {
                if self.collision.is_none() && overlap(&earlier.agent, &other.agent) {
                    self.collision = Some((tick + 1, earlier.agent.name.clone(), other.agent.name.clone()));
                }
            }
        }
    }

    /// Names from the front of the road to its rear at a tick.
    pub fn order_at(&self, tick: usize) -> Vec<&str> {
        let mut order: Vec<usize> = (0..self.names.len()).collect();
        order.sort_by(|a, b| self.states[tick][*b].x_m.total_cmp(&self.states[tick][*a].x_m));
        order.into_iter().map(|index| self.names[index].as_str()).collect()
    }

    /// The first tick at which a vehicle's state satisfies a condition.
    pub fn first(&self, vehicle: usize, when: impl Fn(&State) -> bool) -> Option<usize> {
        self.states.iter().position(|states| when(&states[vehicle]))
    }

    /// Where vehicle 0 is once it has merged (`y > 0.5`): its place from the front, and when \[s\].
    pub fn merged(&self) -> Option<(usize, f64)> {
        let tick = self.first(0, |state| state.y_m > 0.5)?;
        let place = self.order_at(tick).iter().position(|name| *name == self.names[0])?;
        Some((place, STEP_S * tick as f64))
    }

    /// A quantile of the times of vehicle 0's plans \[ms\].
    pub fn plan_time_ms(&self, quantile: f64) -> f64 {
        let mut times = self.plan_ms.clone();
        times.sort_by(f64::total_cmp);
        times[((times.len() - 1) as f64 * quantile) as usize]
    }
}

/// Whether two footprints overlap: no edge of either separates them.
fn overlap(a: &Agent, b: &Agent) -> bool {
    let (corners, other_corners) = (a.body.corners(&a.state), b.body.corners(&b.state));
    let axes = [a, b].map(|agent| agent.state.heading_rad.sin_cos());
    axes.iter().flat_map(|(sin, cos)| [[*cos, *sin], [-sin, *cos]]).all(|[x, y]| {
        let shadow = |corners: &[[f64; 2]; 4]| {
            let along = corners.map(|corner| corner[0] * x + corner[1] * y);
            along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(*at), high.max(*at)))
        };
        let ((low, high), (other_low, other_high)) = (shadow(&corners), shadow(&other_corners));
        low < other_high && other_low < high
    })
}
