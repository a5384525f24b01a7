//! A planner: whoever keeps two seconds behind the car ahead.

// shown from here
use interplay_planners::diagnostic::{DiagnosticQuantity, ValueSet};
use interplay_planners::predict::steady;
use interplay_planners::{Bicycle, Plan, PlanError, Scene, Trajectory};

/// The speed at which the time headway is kept.
const ALLOWED_SPEED: DiagnosticQuantity = DiagnosticQuantity::new("allowed speed", "m/s", ValueSet::NonNegative);

/// Straight on; brakes as hard as it must to keep a time headway to the vehicle ahead.
struct Careful {
    headway_s: f64,
}

impl Careful {
    /// Plans the next move.
    ///
    /// # Errors
    /// [`PlanError::BadInput`] if the scene holds a number that is not finite.
    fn plan(&mut self, scene: &Scene) -> Result<Plan, PlanError> {
        let ego = &scene.ego;
        if !ego.state.is_finite() {
            return Err(PlanError::BadInput(format!("the state of `{}`", ego.name)));
        }
        let ahead = scene.others.iter().filter(|other| ego.shares_lane_with(other) && ego.lead_of(other) > 0.0);
        let gap_m = ahead.map(|other| ego.lead_of(other) - ego.body.front_m - other.body.rear_m).min_by(f64::total_cmp);
        let allowed_mps = gap_m.map_or(f64::INFINITY, |gap_m| gap_m.max(0.0) / self.headway_s);
        let wanted_mps = scene.goal.target.speed_mps.min(allowed_mps);
        let acceleration_mps2 = (wanted_mps - ego.state.speed_mps) / scene.step_s;
        let inputs = steady(&ego.state, acceleration_mps2, &ego.limits, scene.horizon, scene.step_s);
        let model = Bicycle::new(&ego.body, scene.step_s);
        let mut states = vec![ego.state];
        states.extend(inputs.iter().scan(ego.state, |state, input| {
            *state = model.step(state, input);
            Some(*state)
        }));
        Ok(Plan {
            trajectory: Trajectory { states, inputs },
            diagnostics: vec![ALLOWED_SPEED.is(allowed_mps.min(99.0))],
            ..Plan::default()
        })
    }
}
// shown until here

use interplay_planners::Limits;
use interplay_planners::predict::constant_velocity;
use interplay_planners::traffic::{Origin, RoadUser, Traffic};
use interplay_planners::{Agent, Body, Corridor, Goal, Input, SafetyEllipse, State};

fn agent(name: &str, x_m: f64, speed_mps: f64) -> Agent {
    let state = State { x_m, y_m: 0.185, heading_rad: 0.0, speed_mps };
    Agent {
        name: name.to_owned(),
        state,
        previous_input: Input::default(),
        body: Body::default(),
        limits: Limits::default(),
        route: Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.37, end: None }.into(),
        prediction: constant_velocity(&state, 30, 0.1),
        shared_goal: None,
        can_be_asked: true,
    }
}

#[test]
fn a_planner_of_one_s_own_keeps_its_distance() {
    let mut planner = Careful { headway_s: 2.0 };
    let (ego, leader) = (agent("ego", 0.0, 1.0), agent("leader", 2.0, 0.4));
    let target = State { speed_mps: 1.0, ..ego.state };
    let goal = Goal { target, tracking: [0.0, 1.0, 0.5, 1.0], comfort: [0.1; 2], safety: SafetyEllipse::default() };
    let road_users = vec![RoadUser::new(ego, goal, false), RoadUser::new(leader, goal, true)];
    let mut traffic = Traffic { tick: 0, step_s: 0.1, horizon: 30, road_users };
    for tick in 0..200 {
        let decisions = traffic.drive(|index, scene| match index {
            0 => planner.plan(scene),
            _ => Ok(Plan { trajectory: constant_velocity(&scene.ego.state, 30, 0.1), ..Plan::default() }),
        });
        assert!(decisions.iter().all(|decision| decision.origin == Origin::Planned), "at {} s", 0.1 * f64::from(tick));
        let [ego, leader] = [0, 1].map(|index| &traffic.road_users[index].agent);
        assert!(ego.lead_of(leader) > 0.4, "the bumpers touch at {} s", 0.1 * f64::from(tick));
    }
    let [mut ego, leader] = [0, 1].map(|index| traffic.road_users[index].agent.clone());
    assert!((ego.state.speed_mps - 0.4).abs() < 0.01, "it drives as fast as the leader: {:?}", ego.state);
    assert!((ego.lead_of(&leader) - 0.4 - 2.0 * 0.4).abs() < 0.05, "two seconds behind: {}", ego.lead_of(&leader));
    ego.state.x_m = f64::NAN;
    let scene = Scene { tick: 0, step_s: 0.1, horizon: 30, ego, goal, others: Vec::new() };
    assert!(matches!(planner.plan(&scene), Err(PlanError::BadInput(_))));
}
