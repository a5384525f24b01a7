//! Planning is a function of plain values: the same scene gives the same plan, bit for bit.
//!
//! The test rebuilds every scene of a run from its frames and asks planners of its own. That holds the loop to its order
//! (humans from the front of the road to its rear, each knowing the plans of those before; then the others, who know the
//! humans' plans) and to the dissertation's assumption of perfect prediction. A driver that infers plans sees states only, through
//! its own sensor if it has one.

use std::fs;
use std::sync::Arc;

use interplay_planners::perception::sensing::Sensor;
use interplay_planners::prediction::{steadily_along, without_plans};
use interplay_planners::scene::{Knowledge, OwnPlace};
use interplay_planners::{Agent, Goal, Planner, Scene, Trajectory};
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::frame::{Frame, Origin, VehicleFrame};

use crate::command::{interplay, scratch};
use crate::film::{FILMS, Film, authored, film};

/// All vehicles at the start of a tick, each expected to follow its last plan.
fn agents(film: &Film, tick: usize) -> Vec<Agent> {
    let Film { scenario, frames, .. } = film;
    let before = tick.checked_sub(1).map(|before| &frames[before]);
    let seen = frames[tick].vehicles.iter().zip(&scenario.vehicles).enumerate();
    seen.map(|(index, (now, vehicle))| Agent {
        name: vehicle.name.clone(),
        state: now.state,
        own_place: OwnPlace::default(),
        previous_input: before.map(|frame| frame.vehicles[index].input).unwrap_or_default(),
        body: vehicle.body,
        limits: vehicle.limits,
        route: Arc::clone(&vehicle.route),
        prediction: expected(scenario, before.map(|frame| &frame.vehicles[index]), now, vehicle).into(),
        shared_goal: vehicle.driver.shared_goal(&goal(scenario, vehicle)),
        can_be_asked: vehicle.driver.can_be_asked(),
        is_obstacle: vehicle.obstacle.is_some(),
        indicator: None,
        rules: now.rules.clone(),
        urgency: now.urgency,
    })
    .collect()
}

/// The prediction of a vehicle that has not planned in this tick: its last plan, else constant velocity.
fn expected(scenario: &Scenario, before: Option<&VehicleFrame>, now: &VehicleFrame, vehicle: &Vehicle) -> Trajectory {
    let Some(before) = before else {
        return steadily_along(&vehicle.route, &vehicle.body, &now.state, scenario.horizon_steps, scenario.step_s);
    };
    let mut plan = before.plan.trajectory.shifted();
    plan.states[0] = now.state;
    plan
}

/// The vehicles in the order in which they plan.
fn order(scenario: &Scenario, frame: &Frame) -> Vec<usize> {
    let along = |index: usize| scenario.vehicles[index].route.along(frame.vehicles[index].state.position());
    let (mut first, then): (Vec<usize>, Vec<usize>) =
        (0..scenario.vehicles.len()).partition(|index| scenario.vehicles[*index].driver.goes_first());
    first.sort_by(|a, b| along(*b).total_cmp(&along(*a)));
    first.into_iter().chain(then).collect()
}

fn scene(film: &Film, tick: usize, index: usize, agents: &[Agent]) -> Scene {
    let (scenario, vehicle) = (&film.scenario, &film.scenario.vehicles[index]);
    let mut others = agents.to_vec();
    let ego = others.remove(index);
    let goal = goal(scenario, vehicle);
    let (step_s, horizon) = (scenario.step_s, scenario.horizon_steps);
    let scene = Scene { tick, step_s, horizon, knowledge: Knowledge::Plans, ego, goal, others };
    if vehicle.driver.knows_plans() { scene } else { without_plans(scene) }
}

fn goal(scenario: &Scenario, vehicle: &Vehicle) -> Goal {
    Goal {
        target: vehicle.target(&scenario.road),
        tracking: vehicle.weights.tracking(),
        comfort: vehicle.weights.comfort(),
        safety: vehicle.safety,
    }
}

#[test]
fn new_planners_make_the_same_decisions_in_the_same_scenes() {
    for film in FILMS.iter() {
        let mut planners: Vec<Planner> = film.scenario.vehicles.iter().map(|vehicle| vehicle.planner()).collect();
        let mut sensors: Vec<Option<Sensor>> =
            film.scenario.vehicles.iter().map(|vehicle| vehicle.sensor(film.scenario.seed)).collect();
        for (tick, frame) in film.frames.iter().enumerate().take(60) {
            let mut agents = agents(film, tick);
            for index in order(&film.scenario, frame) {
                let seen = &frame.vehicles[index];
                let at = format!("{}: {} at tick {tick}", film.name(), seen.name);
                if seen.origin == Origin::Crashed {
                    agents[index].prediction = seen.plan.trajectory.clone().into();
                    continue;
                }
                let scene = scene(film, tick, index, &agents);
                let outcome = match &mut sensors[index] {
                    Some(sensor) => planners[index].plan_sensed(&sensor.sense(&scene)),
                    None => planners[index].plan(&scene),
                };
                match outcome {
                    Ok(plan) => assert!(plan == *seen.plan, "{at}: another plan"),
                    Err(error) => assert_ne!(seen.origin, Origin::Planned, "{at}: {error}"),
                }
                if film.scenario.vehicles[index].driver.goes_first() {
                    agents[index].prediction = seen.plan.trajectory.clone().into();
                }
            }
        }
    }
}

/// What the recording shows as the prediction of a human is what the ego reckoned with: the human's plan.
#[test]
fn the_prediction_of_a_human_is_its_plan() {
    for film in FILMS.iter() {
        for (tick, frame) in film.frames.iter().enumerate() {
            for (seen, vehicle) in frame.vehicles.iter().zip(&film.scenario.vehicles) {
                if vehicle.driver.goes_first() {
                    let at = format!("{}: {} at tick {tick}", film.name(), seen.name);
                    assert!(*seen.prediction == seen.plan.trajectory, "{at}");
                }
            }
        }
    }
}

/// The prediction of another planner is its last plan, and constant velocity before its first.
#[test]
fn the_prediction_of_a_planner_is_its_last_plan() {
    for film in FILMS.iter() {
        for (tick, frame) in film.frames.iter().enumerate() {
            for (index, vehicle) in film.scenario.vehicles.iter().enumerate() {
                if !vehicle.driver.goes_first() {
                    let expected = &agents(film, tick)[index].prediction;
                    let found = &frame.vehicles[index].prediction;
                    assert!(found == expected, "{}: {} at tick {tick}", film.name(), vehicle.name);
                }
            }
        }
    }
}

/// Among vehicles that do not plan first, the order in which they are listed gives no advantage.
#[test]
fn the_listed_order_of_two_planners_gives_no_advantage() {
    let changes = ["duration_s=3", "vehicle.front.driver.kind=\"conservative\"", "expect.completes=[]"];
    let mut scenario = authored("lane-change/front-nice", &changes);
    scenario.vehicles.retain(|vehicle| vehicle.name != "rear");
    let listed = film("ego first", scenario.clone());
    scenario.vehicles.reverse();
    let reversed = film("ego last", scenario);
    for (tick, (one, other)) in listed.frames.iter().zip(&reversed.frames).enumerate() {
        for (a, b) in one.vehicles.iter().zip(other.vehicles.iter().rev()) {
            assert_eq!((&a.name, a.state), (&b.name, b.state), "tick {tick}");
            assert!(a.prediction == b.prediction, "{} at tick {tick}", a.name);
        }
    }
}

const SCRIPT: &str = r#"{"tick": 0, "type": "input", "acceleration": 0.3, "steering": 0.0, "assist": true}
{"tick": 4, "type": "input", "acceleration": 0.2, "steering": 1.0, "assist": true}
{"tick": 12, "type": "rewind", "seconds": 0.5}
{"tick": 14, "type": "hand_over", "to": "conservative"}
{"tick": 25, "type": "hand_over", "to": null}
{"tick": 30, "type": "input", "acceleration": -0.4, "steering": -0.1}
{"tick": 40, "type": "end"}
"#;

#[test]
fn a_played_run_repeats_with_the_same_digest() {
    let folder = scratch("played");
    fs::write(folder.join("drive.jsonl"), SCRIPT).expect("the folder can be written");
    let play = ["play", "lane-change/front-nice", "--input", "drive.jsonl", "--out", "again/played.toml", "--json"];
    let played = interplay(&folder, &play).json();
    assert!(played["score"]["you"]["smallest_gap_m"].is_number(), "{played}");
    let again = interplay(&folder, &["run", "again/played.toml", "--no-record", "--json"]).json();
    assert_eq!(again["digest"], played["digest"]);
    let text = fs::read_to_string(folder.join("again/played.toml")).expect("written");
    assert!(text.contains("kind = \"inputs\"") && text.contains("to = \"conservative\""), "{text}");
}

/// A front driver that yields is not asked again; the ego waits for one that does not yield.
#[test]
fn negotiation_reacts_to_a_person_in_the_other_car() {
    let folder = scratch("played-front");
    let order = |acceleration: &str| {
        let line = format!(
            "{{\"tick\": 0, \"type\": \"input\", \"acceleration\": {acceleration}, \"steering\": 0, \"assist\": true}}\n"
        );
        let release = "{\"tick\": 12, \"type\": \"input\", \"acceleration\": 0, \"steering\": 0, \"assist\": true}\n";
        fs::write(folder.join("front.jsonl"), line + release).expect("the folder can be written");
        let out = format!("front{acceleration}.toml");
        let play = ["play", "lane-change/front-nice", "--as", "front", "--input", "front.jsonl", "--out", &out];
        interplay(&folder, &play);
        let report = interplay(&folder, &["run", &out, "--no-record", "--json"]).json();
        report["order"].as_array().expect("an order").iter().map(|name| name.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(order("-0.3")[0], "\"ego\"", "the ego goes first ahead of who brakes");
    assert_eq!(order("0.2")[0], "\"front\"", "and not ahead of who does not");
}

#[test]
fn wrong_scripts_are_refused_before_anything_is_written() {
    let folder = scratch("played-wrong");
    fs::write(folder.join("wrong.jsonl"), "{\"tick\": 1, \"type\": \"fly\"}\n").expect("the folder can be written");
    fs::write(folder.join("drive.jsonl"), SCRIPT).expect("the folder can be written");
    for (arguments, part) in [
        (&["lane-change/front-nice", "--as", "stranger", "--input", "drive.jsonl"][..], "choose from ego, front, rear"),
        (&["lane-change/front-nice", "--input", "wrong.jsonl"], "wrong.jsonl:1: unknown variant `fly`"),
        (&["lane-change/front-nice", "--input", "nowhere.jsonl"], "cannot read nowhere.jsonl"),
        (
            &["lane-change/front-nice", "--input", "drive.jsonl", "--out", "drive.jsonl"],
            "would overwrite `drive.jsonl`",
        ),
        (&["building/four-room-pid", "--input", "drive.jsonl"], "no vehicle that a person can drive"),
        (&["lane-change/front-nice", "--join", "ego"], "the seat of the first page already"),
    ] {
        let outcome = interplay(&folder, &[&["play"], arguments].concat());
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(part), "{arguments:?}: {}", outcome.stderr);
        assert!(!folder.join("played").exists());
    }
    assert_eq!(fs::read_to_string(folder.join("drive.jsonl")).expect("there"), SCRIPT);
}
