//! What a scenario file may say about drivers, and what the options do that all of them share.

mod common;

use common::world::{HORIZON, LANES, STEP_S, Vehicle, vehicle};
use interplay_planners::drivers::{conservative, human};
use interplay_planners::prediction::{Prediction, constant_velocity};
use interplay_planners::scene::Knowledge;
use interplay_planners::{Driver, Plan, Scene, State};
use serde_json::json;

/// The kinds of drivers, from the schema of scenario files.
fn kinds() -> Vec<String> {
    let schema = schemars::schema_for!(Driver).to_value();
    let variants = schema["oneOf"].as_array().expect("one entry a kind");
    let word = |variant: &serde_json::Value| variant["properties"]["kind"]["const"].as_str().map(str::to_owned);
    variants.iter().map(|variant| word(variant).expect("every kind has its word")).collect()
}

fn driver(value: serde_json::Value) -> Result<Driver, serde_json::Error> {
    serde_json::from_value(value)
}

#[test]
fn every_kind_of_driver_has_defaults_and_reads_back_as_written() {
    for kind in kinds() {
        let read = driver(json!({ "kind": kind })).expect("every setting has a default");
        assert_eq!(read.kind(), kind);
        let written = serde_json::to_value(&read).expect("it can be written");
        assert_eq!(driver(written).expect("it can be read again"), read);
    }
}

#[test]
fn unknown_settings_are_refused() {
    for kind in kinds() {
        let error = driver(json!({ "kind": kind, "colour": 1 })).expect_err("no driver has a colour");
        assert!(error.to_string().contains("colour"), "{kind}: {error}");
    }
}

#[test]
fn settings_select_values_solutions_and_predictions_by_word() {
    let exact = driver(json!({ "kind": "bayesian", "value": "exact", "prediction": "constant-velocity" }));
    assert!(matches!(exact, Ok(Driver::Bayesian(settings)) if settings.prediction == Prediction::ConstantVelocity));
    let nash = driver(json!({ "kind": "game", "solution": "nash", "prospect": { "lambda": 1.0 } }));
    assert!(matches!(nash, Ok(Driver::Game(settings)) if settings.prospect.lambda == 1.0));
    let script = driver(json!({ "kind": "scripted", "script": [{ "from_s": 1.0, "speed_mps": 0.5 }] }));
    assert!(matches!(script, Ok(Driver::Scripted(settings)) if settings.script.len() == 1));
}

/// One step of a driver beside another vehicle that plans `plan`.
fn beside(driver: Driver, other: &Vehicle) -> Plan {
    let own = vehicle("own", [-0.5, LANES[1], 1.2], [LANES[1], 1.2], [0.0, 4.0, 1.0, 1.0], driver);
    let others = vec![other.agent.clone()];
    let scene = Scene {
        tick: 0,
        step_s: STEP_S,
        horizon: HORIZON,
        knowledge: Knowledge::Plans,
        ego: own.agent,
        goal: own.goal,
        others,
    };
    own.driver.planner().plan(&scene).expect("a plan")
}

/// A vehicle in the other lane that plans to cut in, and does not show it yet.
fn intending() -> Vehicle {
    let tracking = [0.0, 4.0, 1.0, 1.0];
    let driver = Driver::Conservative(conservative::Settings::default());
    let mut other = vehicle("other", [0.1, LANES[0], 1.0], [LANES[1], 1.0], tracking, driver);
    let mut plan = constant_velocity(&other.agent.state, HORIZON, STEP_S);
    for (t, state) in plan.states.iter_mut().enumerate() {
        *state = State { y_m: LANES[0] + (LANES[1] - LANES[0]) * (t as f64 / 10.0).min(1.0), ..*state };
    }
    other.agent.prediction = plan.into();
    other
}

#[test]
fn drivers_that_know_plans_react_before_drivers_that_extrapolate() {
    let other = intending();
    let slowest =
        |plan: &Plan| plan.trajectory.states.iter().map(|state| state.speed_mps).fold(f64::INFINITY, f64::min);
    let human = |prediction| Driver::Human(human::Settings { prediction, ..human::Settings::default() });
    let wary = |prediction| Driver::Conservative(conservative::Settings { prediction, ..Default::default() });
    for driver in [&human as &dyn Fn(Prediction) -> Driver, &wary] {
        let knows = slowest(&beside(driver(Prediction::Plan), &other));
        let extrapolates = slowest(&beside(driver(Prediction::ConstantVelocity), &other));
        assert!(knows < 1.1 && extrapolates > 1.19, "{knows}, {extrapolates}");
    }
}
