//! Vehicles and moments for the tests beside the code.

use std::f64::consts::FRAC_PI_2;

use crate::Limits;
use crate::prediction::constant_velocity;
use crate::rules::RoadRules;
use crate::{Agent, Body, Corridor, Goal, Input, SafetyEllipse, Scene, State};

/// A vehicle at a place on a wide road in its direction, predicted at constant velocity.
pub(crate) fn agent(x_m: f64, y_m: f64, heading_rad: f64, speed_mps: f64) -> Agent {
    let state = State { x_m, y_m, heading_rad, speed_mps };
    Agent {
        name: format!("at {x_m}, {y_m}"),
        state,
        previous_input: Input::default(),
        body: Body::default(),
        limits: Limits::default(),
        route: Corridor { heading_rad, right_m: -2.0, left_m: 2.0, end: None }.into(),
        prediction: constant_velocity(&state, 30, 0.1).into(),
        shared_goal: None,
        can_be_asked: true,
        is_obstacle: false,
        rules: RoadRules::default(),
        urgency: 1.0,
    }
}

/// A vehicle that drives along y.
pub(crate) fn crossing(x_m: f64, y_m: f64, speed_mps: f64) -> Agent {
    agent(x_m, y_m, FRAC_PI_2, speed_mps)
}

/// A moment of an ego that wants to go on as it does.
pub(crate) fn scene(ego: Agent, others: Vec<Agent>) -> Scene {
    let goal = Goal { target: ego.state, tracking: [0.0; 4], comfort: [0.1; 2], safety: SafetyEllipse::default() };
    Scene { tick: 0, step_s: 0.1, horizon: 30, ego, goal, others }
}
