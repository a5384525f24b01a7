//! Vehicles and moments for the tests beside the code.

use std::f64::consts::FRAC_PI_2;

use crate::Limits;
use crate::prediction::constant_velocity;
use crate::rules::RoadRules;
use crate::scene::Knowledge;
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
        indicator: None,
        rules: RoadRules::default(),
        urgency: 1.0,
        own_place: Default::default(),
    }
}

/// A real car along the x axis, on a road of three lanes.
pub(crate) fn real_car(x_m: f64, speed_mps: f64) -> Agent {
    let ratio = Body::REAL_SCALE;
    let Body { front_m, rear_m, width_m, front_axle_m, rear_axle_m, .. } = Body::default();
    let [front_m, rear_m, width_m, front_axle_m, rear_axle_m] =
        [front_m, rear_m, width_m, front_axle_m, rear_axle_m].map(|length_m| ratio * length_m);
    Agent {
        body: Body { front_m, rear_m, width_m, front_axle_m, rear_axle_m, scale: ratio },
        limits: Limits {
            acceleration_min_mps2: -7.0,
            acceleration_max_mps2: 3.0,
            speed_min_mps: 0.0,
            speed_max_mps: 50.0,
            ..Limits::default()
        },
        route: Corridor { heading_rad: 0.0, right_m: -5.25, left_m: 5.25, end: None }.into(),
        ..agent(x_m, 0.0, 0.0, speed_mps)
    }
}

/// A vehicle that drives along y.
pub(crate) fn crossing(x_m: f64, y_m: f64, speed_mps: f64) -> Agent {
    agent(x_m, y_m, FRAC_PI_2, speed_mps)
}

/// A moment of an ego that wants to go on as it does.
pub(crate) fn scene(ego: Agent, others: Vec<Agent>) -> Scene {
    let goal = Goal { target: ego.state, tracking: [0.0; 4], comfort: [0.1; 2], safety: SafetyEllipse::default() };
    Scene { tick: 0, step_s: 0.1, horizon: 30, knowledge: Knowledge::Plans, ego, goal, others }
}
