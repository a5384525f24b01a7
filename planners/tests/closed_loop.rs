//! Planners and humans together on a road, with the bicycle as the plant.

use interplay_planners::Bicycle;
use interplay_planners::Limits;
use interplay_planners::predict::constant_velocity;
use interplay_planners::{
    Agent, Body, Corridor, Driver, Goal, Input, Planner, SafetyEllipse, Scene, State, conservative, human, negotiation,
};

const STEP_S: f64 = 0.1;
const HORIZON: usize = 30;

struct Vehicle {
    agent: Agent,
    goal: Goal,
    planner: Planner,
}

fn vehicle(name: &str, x_m: f64, y_m: f64, speed_mps: f64, wanted: f64, tracking: [f64; 4], driver: Driver) -> Vehicle {
    let state = State { x_m, y_m, heading_rad: 0.0, speed_mps };
    let agent = Agent {
        name: name.to_owned(),
        state,
        previous_input: Input::default(),
        body: Body::default(),
        limits: Limits::default(),
        corridor: Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end: None },
        prediction: constant_velocity(&state, HORIZON, STEP_S),
        shared_goal: None,
    };
    let target = State { x_m: 0.0, y_m: 0.555, heading_rad: 0.0, speed_mps: wanted };
    let goal = Goal { target, tracking, comfort: [0.1, 0.1], safety: SafetyEllipse::default() };
    Vehicle { agent, goal, planner: driver.planner() }
}

/// Humans plan first, from the front of the road to its rear; then the ego, which is vehicle 0.
fn run(vehicles: &mut [Vehicle], ticks: usize, mut watch: impl FnMut(usize, &[Vehicle])) {
    for tick in 0..ticks {
        for index in (1..vehicles.len()).chain([0]) {
            let others = vehicles.iter().enumerate().filter(|(i, _)| *i != index);
            let scene = Scene {
                tick,
                step_s: STEP_S,
                horizon: HORIZON,
                ego: vehicles[index].agent.clone(),
                goal: vehicles[index].goal,
                others: others.map(|(_, other)| other.agent.clone()).collect(),
            };
            let plan = vehicles[index].planner.plan(&scene).expect("a plan");
            vehicles[index].agent.prediction = plan.trajectory;
        }
        for vehicle in vehicles.iter_mut() {
            let agent = &mut vehicle.agent;
            let input = agent.prediction.inputs[0];
            agent.state = Bicycle::new(&agent.body, STEP_S).step(&agent.state, &input);
            agent.previous_input = input;
            agent.prediction = agent.prediction.shifted();
        }
        watch(tick, vehicles);
    }
}

fn lane_change(driver: Driver, styles: [human::Style; 2]) -> (f64, Vec<String>, f64) {
    let human = |style| Driver::Human(human::Settings { style: Some(style), ..human::Settings::default() });
    let tracking = [0.0, 4.0, 1.0, 1.0];
    let mut vehicles = vec![
        vehicle("ego", 0.0, 0.185, 1.0, 1.0, [0.0, 1.0, 0.5, 1.0], driver),
        vehicle("front", -0.4, 0.555, 1.4, 1.4, tracking, human(styles[0])),
        vehicle("rear", -1.7, 0.555, 1.4, 1.4, tracking, human(styles[1])),
    ];
    let (mut merged_s, mut order, mut nearest) = (f64::INFINITY, Vec::new(), f64::INFINITY);
    run(&mut vehicles, 120, |tick, vehicles| {
        let ego = &vehicles[0].agent;
        for other in &vehicles[1..] {
            let d = SafetyEllipse::default().oriented(0.0).distance(ego.state.position(), other.agent.state.position());
            nearest = nearest.min(d.squared.sqrt());
        }
        if ego.state.y_m > 0.5 && merged_s.is_infinite() {
            merged_s = STEP_S * (tick + 1) as f64;
            let mut names: Vec<&Agent> = vehicles.iter().map(|vehicle| &vehicle.agent).collect();
            names.sort_by(|a, b| b.state.x_m.total_cmp(&a.state.x_m));
            order = names.iter().map(|agent| agent.name.clone()).collect();
        }
    });
    (merged_s, order, nearest)
}

/// Who is where once the ego has merged: from the front of the road to its rear.
fn merged_order(driver: Driver, styles: [human::Style; 2]) -> Vec<String> {
    let (merged_s, order, nearest) = lane_change(driver, styles);
    assert!(merged_s.is_finite(), "the ego never merged");
    assert!(nearest > 0.99, "the ego entered a safety ellipse: {nearest}");
    order
}

#[test]
fn a_negotiator_goes_ahead_of_nice_drivers_and_a_conservative_one_between_them() {
    let nice = [human::Style::Nice; 2];
    assert_eq!(merged_order(negotiator(), nice), ["ego", "front", "rear"]);
    let conservative = Driver::Conservative(conservative::Settings::default());
    assert_eq!(merged_order(conservative, nice), ["front", "ego", "rear"]);
}

#[test]
fn a_tough_driver_is_let_pass() {
    use human::Style::{Nice, Tough};
    assert_eq!(merged_order(negotiator(), [Tough, Nice]), ["front", "ego", "rear"]);
    assert_eq!(merged_order(negotiator(), [Tough, Tough]), ["front", "rear", "ego"]);
}

fn negotiator() -> Driver {
    Driver::Negotiation(negotiation::Settings::default())
}

/// Drives towards a standing car in the same lane; returns how near the two come, bumper to bumper, and how far a corner of
/// the moving one leaves the road \[m\].
fn towards_a_standing_car(driver: Driver, ahead_m: f64) -> (f64, f64) {
    let tracking = [0.0, 1.0, 0.5, 1.0];
    let mut vehicles = vec![
        vehicle("ego", 0.0, 0.185, 1.0, 1.0, tracking, driver),
        standing(ahead_m, 0.185),
        standing(ahead_m, 0.555),
    ];
    for lane in &mut vehicles[..1] {
        lane.goal.target.y_m = 0.185;
    }
    let (mut gap_m, mut beyond_m) = (f64::INFINITY, 0.0_f64);
    run(&mut vehicles, 80, |_, vehicles| {
        let ego = &vehicles[0].agent;
        gap_m = gap_m.min(ahead_m - ego.state.x_m - ego.body.front_m - ego.body.rear_m);
        let clearances = ego.corridor.clearances(&ego.body, &ego.state);
        beyond_m = clearances.iter().map(|corner| -corner.value).fold(beyond_m, f64::max);
    });
    (gap_m, beyond_m)
}

/// Stands still and wants to.
fn standing(x_m: f64, y_m: f64) -> Vehicle {
    let tough = human::Settings { style: Some(human::Style::Tough), ..human::Settings::default() };
    let mut car = vehicle("car", x_m, y_m, 0.0, 0.0, [0.0, 0.0, 1.0, 1.0], Driver::Human(tough));
    car.agent.name = format!("car at {y_m}");
    car.goal.target.y_m = y_m;
    car
}

#[test]
fn everybody_stops_in_front_of_a_blocked_road() {
    let tough = human::Settings { style: Some(human::Style::Tough), ..human::Settings::default() };
    for ahead_m in [1.5, 2.0, 2.5, 3.0, 3.5] {
        for driver in [Driver::Human(tough), Driver::Conservative(conservative::Settings::default())] {
            let kind = driver.kind();
            let (gap_m, beyond_m) = towards_a_standing_car(driver, ahead_m);
            assert!(gap_m > 0.02, "{kind}: {gap_m} m before a car {ahead_m} m ahead");
            assert!(beyond_m < 1e-3, "{kind}: {beyond_m} m off the road");
        }
    }
}
