//! Plans that must not be driven, and what is done without one.

use interplay_planners::plan::certificate::{Harm, last_resorts, refused, violations};
use interplay_planners::prediction::steadily_along;
use interplay_planners::scene::Knowledge;
use interplay_planners::traffic::{Origin, RoadUser, Traffic};
use interplay_planners::{
    Agent, Body, Corridor, Goal, Input, Limits, Plan, PlanCondition, PlanError, Route, SafetyEllipse, Scene, State,
    Trajectory,
};

const STEP_S: f64 = 0.1;
const HORIZON: usize = 30;

fn agent(name: &str, [x_m, y_m, heading_rad, speed_mps]: [f64; 4]) -> Agent {
    let state = State { x_m, y_m, heading_rad, speed_mps };
    let road = Corridor {
        heading_rad,
        right_m: -0.15 - 10.0 * heading_rad.abs(),
        left_m: 0.15 + 10.0 * heading_rad.abs(),
        end: None,
    };
    let body = Body::default();
    let route: std::sync::Arc<Route> = road.into();
    let prediction = steadily_along(&route, &body, &state, HORIZON, STEP_S);
    Agent {
        name: name.to_owned(),
        state,
        previous_input: Input::default(),
        body,
        limits: Limits::default(),
        route,
        prediction: prediction.into(),
        shared_goal: None,
        can_be_asked: true,
        is_obstacle: false,
        indicator: None,
        rules: interplay_planners::rules::RoadRules::default(),
        urgency: 1.0,
        own_place: Default::default(),
    }
}

fn goal() -> Goal {
    let target = State { x_m: 0.0, y_m: 0.0, heading_rad: 0.0, speed_mps: 1.0 };
    Goal { target, tracking: [0.0, 1.0, 0.1, 1.0], comfort: [0.1; 2], safety: SafetyEllipse::default() }
}

fn scene(ego: Agent, others: Vec<Agent>) -> Scene {
    Scene { tick: 0, step_s: STEP_S, horizon: HORIZON, knowledge: Knowledge::Plans, ego, goal: goal(), others }
}

/// A constant acceleration; the speed stays within its limits.
fn plan(scene: &Scene, acceleration_mps2: f64) -> Trajectory {
    let (mut inputs, mut states) = (Vec::new(), Vec::new());
    let mut speed_mps = scene.ego.state.speed_mps;
    for _ in 0..HORIZON {
        let limits = scene.ego.limits;
        let next_mps = (speed_mps + STEP_S * acceleration_mps2).clamp(limits.speed_min_mps, limits.speed_max_mps);
        inputs.push(Input { acceleration_mps2: (next_mps - speed_mps) / STEP_S, steering_rad: 0.0 });
        speed_mps = next_mps;
    }
    scene.model().roll_out(&scene.ego.state, &inputs, &mut states);
    Trajectory { states, inputs }
}

fn broken(scene: &Scene, plan: &Trajectory) -> Vec<(PlanCondition, usize)> {
    violations(scene, plan).into_iter().map(|violation| (violation.condition, violation.stage)).collect()
}

/// Of a plan that keeps everything each number is made wrong in turn.
#[test]
fn the_certificate_finds_where_each_condition_is_first_violated() {
    let alone = scene(agent("ego", [0.0, 0.0, 0.0, 1.0]), Vec::new());
    let good = plan(&alone, -0.2);
    assert_eq!(broken(&alone, &good), []);
    let with = |change: fn(&mut Trajectory)| {
        let mut plan = good.clone();
        change(&mut plan);
        plan
    };
    let moved = with(|plan| plan.states[7].y_m += 1e-3);
    assert_eq!(broken(&alone, &moved), [(PlanCondition::Dynamics, 7)]);
    let not_a_number = with(|plan| plan.states[9].speed_mps = f64::NAN);
    assert!(broken(&alone, &not_a_number).contains(&(PlanCondition::Dynamics, 9)));
    let short = with(|plan| plan.states.truncate(HORIZON));
    assert!(broken(&alone, &short).contains(&(PlanCondition::Dynamics, 0)));
    let empty = Trajectory::default();
    let beside = scene(agent("ego", [0.0, 0.0, 0.0, 1.0]), vec![agent("other", [3.0, 0.0, 0.0, 0.0])]);
    assert!(broken(&beside, &empty).contains(&(PlanCondition::Dynamics, 0)));
    assert!(refused(&beside, &empty, &violations(&beside, &empty)).is_some());
    let hard = with(|plan| plan.inputs[4].acceleration_mps2 = -1.1);
    assert!(broken(&alone, &hard).contains(&(PlanCondition::InputLimits, 4)));
    for wrong in [moved, not_a_number, short, hard] {
        let found = violations(&alone, &wrong);
        assert!(refused(&alone, &wrong, &found).is_some_and(|violation| violation.is_fault()));
    }
    // It steers off the road, which is 0.15 m wide to either side, and may still go straight on: no reason to refuse it.
    let inputs = vec![Input { acceleration_mps2: 0.0, steering_rad: 0.1 }; HORIZON];
    let mut states = Vec::new();
    alone.model().roll_out(&alone.ego.state, &inputs, &mut states);
    let aside = Trajectory { states, inputs };
    let found = violations(&alone, &aside);
    assert!(matches!(found[..], [ref only] if only.condition == PlanCondition::Road && only.stage > 2), "{found:?}");
    assert_eq!(refused(&alone, &aside, &found), None);
}

/// A vehicle stands ahead. From 1 m/s with 1 m/s² a vehicle stands after 0.5 m (by eq. 6.3 in steps of 0.1 s after 0.55 m or less), so it
/// may keep its speed as long as more room than that is left after the next step, and no longer.
#[test]
fn a_plan_may_end_in_contact_if_an_evasive_motion_remains() {
    let body = Body::default();
    let keeps_speed = |gap_m: f64| {
        let standing = agent("other", [gap_m + body.front_m + body.rear_m, 0.0, 0.0, 0.0]);
        let scene = scene(agent("ego", [0.0, 0.0, 0.0, 1.0]), vec![standing]);
        let plan = plan(&scene, 0.0);
        let found = violations(&scene, &plan);
        assert!(
            matches!(&found[..], [only] if only.condition == PlanCondition::Clear("other".to_owned())),
            "{found:?}"
        );
        refused(&scene, &plan, &found).is_none()
    };
    assert!(keeps_speed(0.7), "there is room for a step and the braking after it");
    assert!(!keeps_speed(0.6), "there is room for braking now, and none after the next step");
    assert!(keeps_speed(0.3), "no way out is left to be given away");
}

/// Without a planner: it brakes before a stationary vehicle, and does not brake to a stand in the way of a crossing one.
#[test]
fn the_least_harmful_motion_is_driven_without_a_plan() {
    let drive = |other: Agent| {
        let crossing = other.state.heading_rad != 0.0;
        let users = [agent("ego", [0.0, 0.0, 0.0, 1.0]), other].map(|agent| RoadUser::new(agent, goal(), false));
        let mut traffic = Traffic { step_s: STEP_S, horizon: HORIZON, road_users: users.into(), ..Traffic::default() };
        let first = traffic.drive(|index, scene| match index {
            // The ego plans to drive on; the other does what it did.
            0 => Ok(Plan { trajectory: plan(scene, 0.0), ..Plan::default() }),
            _ => Ok(Plan { trajectory: (*scene.ego.prediction).clone(), ..Plan::default() }),
        });
        assert_eq!(first[0].origin, Origin::Planned);
        let mut origins = Vec::new();
        let mut nearest = f64::INFINITY;
        for _ in 0..25 {
            let decisions = traffic.drive(|index, scene| match index {
                0 => Err(PlanError::Infeasible("on purpose".to_owned())),
                _ => Ok(Plan { trajectory: steadily(scene), ..Plan::default() }),
            });
            origins.push(decisions[0].origin);
            let [ego, other] = [0, 1].map(|index| {
                let agent = &traffic.road_users[index].agent;
                agent.body.corners(&agent.state)
            });
            nearest = nearest.min(-interplay_planners::plan::certificate::overlap_m(&ego, &other));
        }
        assert!(nearest > 0.0, "touched, crossing {crossing}: {origins:?}");
        origins
    };
    let standing = drive(agent("other", [1.3, 0.0, 0.0, 0.0]));
    assert_eq!(standing[0], Origin::Braking, "the last plan would end in the other");
    // It comes from the right and passes behind the ego if that does not brake.
    let crossing = drive(agent("other", [0.25, -1.35, std::f64::consts::FRAC_PI_2, 1.0]));
    assert_eq!(crossing[0], Origin::Continued, "to go on is harmless");
}

/// Braking would end in the way of a vehicle that crosses from the right; going on passes ahead.
#[test]
fn another_acceleration_is_chosen_if_braking_causes_harm() {
    let crossing = agent("other", [0.45, -1.2, std::f64::consts::FRAC_PI_2, 1.0]);
    let users = [agent("ego", [0.0, 0.0, 0.0, 1.0]), crossing].map(|agent| RoadUser::new(agent, goal(), false));
    let mut traffic = Traffic { step_s: STEP_S, horizon: HORIZON, road_users: users.into(), ..Traffic::default() };
    let braking = last_resorts(&traffic.scene(0)).next().expect("full braking");
    assert!(Harm::measure(&traffic.scene(0), &braking).impact_mps > Some(0.5));
    let decisions = traffic.drive(|index, scene| match index {
        0 => Err(PlanError::Infeasible("on purpose".to_owned())),
        _ => Ok(Plan { trajectory: steadily(scene), ..Plan::default() }),
    });
    assert_eq!(decisions[0].origin, Origin::Evading);
    assert!(Harm::measure(&traffic.scene(0), &decisions[0].plan.trajectory).is_none());
}

fn steadily(scene: &Scene) -> Trajectory {
    steadily_along(&scene.ego.route, &scene.ego.body, &scene.ego.state, HORIZON, STEP_S)
}

/// When nothing helps, the weakest impact is chosen.
#[test]
fn the_least_harmful_motion_has_the_weakest_impact() {
    let ego = agent("ego", [0.0, 0.0, 0.0, 1.0]);
    let scene = scene(ego, vec![agent("other", [0.6, 0.0, 0.0, 0.0])]);
    let impacts: Vec<Option<f64>> =
        last_resorts(&scene).map(|motion| Harm::measure(&scene, &motion).impact_mps).collect();
    assert!(
        impacts[..4].is_sorted() && impacts[0] > Some(0.5),
        "straight on, full braking is the least harmful: {impacts:?}"
    );
}
