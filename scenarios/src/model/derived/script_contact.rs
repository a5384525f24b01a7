//! Whether a script leads through an obstacle.

use std::sync::Arc;

use interplay_planners::plan::certificate::overlap_m;
use interplay_planners::rules::RoadRules;
use interplay_planners::scene::Knowledge;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Agent, Driver, DriverKind, Goal, Input, Scene};

use crate::model::scenario::{Scenario, Vehicle};
use crate::text::error::quoted;

/// Bodies overlap by more than this share of a width where a script leads through an obstacle.
const OVERLAP_WIDTHS: f64 = 0.02;

/// What a script leads through, when, and what would work. Scripts that wait for others (`when`) are not driven ahead.
pub(crate) fn remark(scenario: &Scenario, vehicle: &Vehicle) -> Option<(String, String)> {
    let Driver::Scripted(settings) = &vehicle.driver else { return None };
    let obstacles: Vec<&Vehicle> = scenario.vehicles.iter().filter(|other| other.obstacle.is_some()).collect();
    if obstacles.is_empty() || settings.script.iter().any(|order| order.when.is_some()) {
        return None;
    }
    let scene = alone(scenario, vehicle);
    let plan = settings.driver().plan(&scene, &InferredFutures::default()).ok()?;
    let (begins_s, length_m) = (vehicle.stay.enters_s.unwrap_or(0.0), scene.ego.route.end_m());
    let driven = plan.trajectory.states.iter().take_while(|state| vehicle.route.along(state.position()) <= length_m);
    let met = driven.enumerate().find_map(|(stage, state)| {
        let corners = vehicle.body.corners(state);
        let touches = |other: &&&Vehicle| {
            overlap_m(&corners, &other.body.corners(&other.start)) > OVERLAP_WIDTHS * vehicle.body.width_m
        };
        obstacles.iter().find(touches).map(|other| (begins_s + stage as f64 * scene.step_s, other))
    });
    let (time_s, other) = met?;
    let message =
        format!("the script of {} leads through {} after {time_s:.1} s", quoted(&vehicle.name), quoted(&other.name));
    let help = "an order with `lateral_m` leads past it, one with `speed_mps = 0.0` stops before it".to_owned();
    Some((message, help))
}

/// A vehicle without others around it, over the whole run.
fn alone(scenario: &Scenario, vehicle: &Vehicle) -> Scene {
    let target = vehicle.target(&scenario.road);
    let ego = Agent {
        name: vehicle.name.clone(),
        state: vehicle.start,
        previous_input: Input::default(),
        body: vehicle.body,
        limits: vehicle.limits,
        route: Arc::clone(&vehicle.route),
        prediction: Arc::default(),
        shared_goal: None,
        can_be_asked: false,
        is_obstacle: false,
        indicator: None,
        rules: RoadRules::default(),
        urgency: 1.0,
        own_place: Default::default(),
    };
    let step_s = scenario.planning_period_s();
    Scene {
        tick: (vehicle.stay.enters_s.unwrap_or(0.0) / step_s).round() as usize,
        step_s,
        horizon: scenario.plan_count(),
        knowledge: Knowledge::default(),
        goal: Goal { target, tracking: [0.0; 4], comfort: [0.0; 2], safety: vehicle.safety },
        ego,
        others: Vec::new(),
    }
}
