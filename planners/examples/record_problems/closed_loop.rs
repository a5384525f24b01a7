//! The embedded lane changes in a tiny closed loop: no physics, every vehicle moves as the bicycle says.

use interplay_planners::Bicycle;
use interplay_planners::Limits;
use interplay_planners::human::{self, Style};
use interplay_planners::predict::constant_velocity;
use interplay_planners::{
    Agent, Body, Corridor, Driver, Goal, Input, Plan, Planner, SafetyEllipse, Scene, State, Trajectory,
};

use crate::Result;

const STEP_S: f64 = 0.1;
const HORIZON: usize = 30;
const TICKS: usize = 120;

/// What sets the lane changes apart.
#[derive(Clone, Copy)]
pub struct Scenario {
    /// Its name.
    pub name: &'static str,
    front: Style,
    rear: Style,
    /// Where the front one starts \[m\]; the other is 1.3 m behind it.
    front_x_m: f64,
    /// How fast both drive \[m/s\].
    speed_mps: f64,
}

/// The lane changes of `scenarios/files/lane-change/`.
pub const SCENARIOS: [Scenario; 3] = [
    Scenario { name: "front-nice", front: Style::Nice, rear: Style::Nice, front_x_m: -0.35, speed_mps: 1.25 },
    Scenario { name: "front-tough", front: Style::Tough, rear: Style::Nice, front_x_m: -0.35, speed_mps: 1.25 },
    Scenario { name: "both-tough", front: Style::Tough, rear: Style::Tough, front_x_m: -0.4, speed_mps: 1.4 },
];

/// One driver's decision.
pub struct Decision<'a> {
    /// Who decides.
    pub driver: &'a Driver,
    /// What it was shown.
    pub scene: &'a Scene,
    /// What it planned the step before.
    pub last: Option<&'a Trajectory>,
    /// What it answered.
    pub plan: &'a Plan,
}

struct Vehicle {
    agent: Agent,
    goal: Goal,
    driver: Driver,
    planner: Planner,
    last: Option<Trajectory>,
}

fn vehicle(name: &str, [x_m, y_m, speed_mps]: [f64; 3], tracking: [f64; 4], driver: Driver) -> Vehicle {
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
    let target = State { x_m: 0.0, y_m: 0.555, heading_rad: 0.0, speed_mps };
    let goal = Goal { target, tracking, comfort: [0.1, 0.1], safety: SafetyEllipse::default() };
    Vehicle { agent, goal, planner: driver.planner(), driver, last: None }
}

/// Drives a scenario with `ego` as the ego's driver and shows every decision to `watch`. The humans plan first, from the
/// front of the road to its rear. A cooperative ego needs somebody to cooperate with: then it drives the front car too.
///
/// # Errors
/// A planner's, or that of `watch`.
pub fn run(scenario: &Scenario, ego: &Driver, mut watch: impl FnMut(&Decision) -> Result<()>) -> Result<()> {
    let human = |style| Driver::Human(human::Settings { style: Some(style), ..Default::default() });
    let front = if matches!(ego, Driver::Cooperative(_)) { ego.clone() } else { human(scenario.front) };
    let mut vehicles = [
        vehicle("front", [scenario.front_x_m, 0.555, scenario.speed_mps], [0.0, 4.0, 1.0, 1.0], front),
        vehicle(
            "rear",
            [scenario.front_x_m - 1.3, 0.555, scenario.speed_mps],
            [0.0, 4.0, 1.0, 1.0],
            human(scenario.rear),
        ),
        vehicle("ego", [0.0, 0.185, 1.0], [0.0, 1.0, 0.5, 1.0], ego.clone()),
    ];
    for Vehicle { agent, goal, driver, .. } in &mut vehicles {
        agent.shared_goal = driver.shared_goal(goal);
    }
    for tick in 0..TICKS {
        for index in 0..vehicles.len() {
            let scene = scene(tick, &vehicles, index);
            let Vehicle { agent, driver, planner, last, .. } = &mut vehicles[index];
            let plan = planner.plan(&scene)?;
            watch(&Decision { driver, scene: &scene, last: last.as_ref(), plan: &plan })?;
            agent.prediction = plan.trajectory.clone();
            *last = Some(plan.trajectory);
        }
        for Vehicle { agent, .. } in &mut vehicles {
            let input = agent.prediction.inputs[0];
            agent.state = Bicycle::new(&agent.body, STEP_S).step(&agent.state, &input);
            agent.previous_input = input;
            agent.prediction = agent.prediction.shifted();
        }
    }
    Ok(())
}

/// The moment as one vehicle sees it.
fn scene(tick: usize, vehicles: &[Vehicle], index: usize) -> Scene {
    let others = vehicles.iter().enumerate().filter(|(other, _)| *other != index);
    Scene {
        tick,
        step_s: STEP_S,
        horizon: HORIZON,
        ego: vehicles[index].agent.clone(),
        goal: vehicles[index].goal,
        others: others.map(|(_, vehicle)| vehicle.agent.clone()).collect(),
    }
}
