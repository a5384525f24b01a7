//! Among people, no driver knows the future: what happens before a time does not depend on what is decided after it.

use interplay_planners::Input;
use interplay_planners::drivers::scripted::{Order, Scripted, Settings};
use interplay_scenarios::{Scenario, from_text};
use interplay_simulation::Simulation;
use interplay_simulation::frame::{Frame, VehicleFrame};
use rayon::prelude::*;

use crate::film::{Film, authored, film};

/// Every kind of driver that decides for itself how it drives.
const KINDS: [&str; 9] =
    ["human", "idm", "conservative", "negotiation", "bayesian", "game", "cooperative", "nash", "contingency"];

/// Streets with an ego, and the vehicle there whose decision changes.
const STREETS: [(&str, &str); 3] =
    [("people/lane-change", "front"), ("people/intersection", "crossing"), ("people/ramp-merge", "front")];

/// When the decision changes \[s\].
const CHANGE_S: f64 = 4.0;
/// How long runs are watched after it \[s\].
const WATCHED_S: f64 = 4.0;

/// A street whose ego is of a kind.
fn street(name: &str, kind: &str) -> Scenario {
    let kind = format!("vehicle.ego.driver.kind=\"{kind}\"");
    let duration = format!("duration_s={}", CHANGE_S + WATCHED_S);
    authored(name, &[&kind, &duration, "expect={}", "counterfactual=[]"])
}

/// A driver that brakes for no reason.
fn braking() -> Scripted {
    let order = Order { speed_mps: Some(0.0), acceleration_mps2: Some(4.0), ..Order::default() };
    Scripted::new(Settings { script: vec![order] })
}

/// The applied inputs of each vehicle from the change on; with `changed`, of a run in which this vehicle begins to brake then.
fn inputs_after_change(scenario: &Scenario, changed: Option<&str>) -> Vec<Vec<Input>> {
    let mut simulation = Simulation::new(scenario).expect("a scenario without fault");
    simulation.advance_to(CHANGE_S).expect("the run goes on");
    if let Some(changed) = changed {
        simulation.drive_with(changed, braking()).expect("a vehicle of the scenario");
    }
    let mut inputs = Vec::new();
    while let Some(frame) = simulation.step().expect("the run goes on") {
        inputs.push(frame.vehicles.iter().map(|vehicle| vehicle.input).collect());
    }
    inputs
}

/// What each vehicle but the changed one does before it can have seen the change is the same without it, and the change shows.
fn reacts_in_time(what: &str, scenario: &Scenario, changed: &str) {
    let [usual, other] = [None, Some(changed)].map(|changed| inputs_after_change(scenario, changed));
    let plan_s = scenario.step_s * scenario.ticks_per_plan as f64;
    let index_of = |name: &str| scenario.vehicles.iter().position(|vehicle| vehicle.name == name).expect("a vehicle");
    let changes = index_of(changed);
    assert!(usual.iter().zip(&other).any(|(a, b)| a[changes] != b[changes]), "{what}: nothing was changed");
    for (row, vehicle) in scenario.vehicles.iter().enumerate().filter(|(row, _)| *row != changes) {
        let blind_s = plan_s + vehicle.driver.reaction_s();
        let blind = (blind_s / scenario.step_s).round() as usize;
        for (tick, (a, b)) in usual.iter().zip(&other).enumerate().take(blind) {
            let time_s = scenario.step_s * tick as f64;
            assert_eq!(a[row], b[row], "{what}: {} knew at {time_s} s", vehicle.name);
        }
    }
}

#[test]
fn no_driver_reacts_to_a_change_before_it_can_have_seen_it() {
    let all: Vec<_> = STREETS.iter().flat_map(|street| KINDS.map(|kind| (street, kind))).collect();
    all.par_iter().for_each(|((name, changed), kind)| {
        reacts_in_time(&format!("{name}, {kind}"), &street(name, kind), changed);
    });
}

#[test]
#[ignore = "200 generated streets take ten minutes: cargo test --release -p interplay-tests generated_streets -- --ignored"]
fn no_driver_on_generated_streets_reacts_before_it_can_have_seen_a_change() {
    let kinds = ["bus", "crossing", "dense", "drop", "equal", "narrow", "parked", "ramp", "ring", "tee"];
    let numbers = (0..200).map(|number| (kinds[number % kinds.len()], 6000 + number / kinds.len()));
    let streets: Vec<_> = numbers.zip(KINDS.iter().cycle()).collect();
    streets.par_iter().for_each(|((name, number), kind)| {
        let name = format!("streets/{name}/{number}");
        let scenario = street(&name, kind);
        let others = scenario.vehicles.iter().filter(|it| it.name != "ego" && it.start.speed_mps > 1.0);
        let changed = others.into_iter().find(|it| it.stay.enters_s.is_none() && it.driver.can_take_wheel());
        if let Some(changed) = changed {
            reacts_in_time(&format!("{name}, {kind}"), &scenario, &changed.name);
        }
    });
}

/// What is the same before a change, of a vehicle.
fn known(vehicle: &VehicleFrame) -> impl PartialEq + std::fmt::Debug + use<'_> {
    let VehicleFrame { state, input, rules, urgency, plan, .. } = vehicle;
    (state, input, rules, urgency, &plan.beliefs)
}

/// Two runs are the same in every tick before a time, and differ after it.
fn are_equal_before(what: &str, [one, other]: [&Film; 2], until_s: f64) {
    let is_before = |frame: &&Frame| frame.time_s < until_s - 1e-9;
    for (a, b) in one.frames.iter().zip(&other.frames).take_while(|(frame, _)| is_before(frame)) {
        for (a_vehicle, b_vehicle) in a.vehicles.iter().zip(&b.vehicles) {
            assert_eq!(known(a_vehicle), known(b_vehicle), "{what}: {} at {} s", a_vehicle.name, a.time_s);
        }
    }
    let last =
        |film: &Film| film.frames.last().map(|frame| frame.vehicles.iter().map(|it| it.state).collect::<Vec<_>>());
    assert_ne!(last(one), last(other), "{what}: the change shows nowhere");
}

/// A street with an ego, a vehicle ahead whose driver is stated, and a person behind the ego.
fn column(driver: &str, enters: &str, kind: &str) -> Scenario {
    let text = format!(
        "title = 'a column'\nshows = 'three cars'\nduration_s = 8\ndefaults = {{ class = 'car' }}\n\
         road = {{ kind = 'crossing' }}\n\
         vehicle = [\n\
         {{ name = 'ego', start = {{ lane = 'west-in', along_m = 20, speed_mps = 12 }}, \
            goal = {{ lane = 'east-out', speed_mps = 12 }}, driver = {{ kind = '{kind}' }} }},\n\
         {{ name = 'ahead', start = {{ lane = 'west-in', along_m = 45, speed_mps = 12 }}, \
            goal = {{ lane = 'east-out', speed_mps = 12 }}, driver = {driver} }},\n\
         {{ name = 'late', start = {{ lane = 'south-in', along_m = 10, speed_mps = 10 }}, \
            goal = {{ lane = 'north-out', speed_mps = 10 }}, {enters} }},\n\
         {{ name = 'behind', start = {{ lane = 'west-in', along_m = 0, speed_mps = 12 }}, \
            goal = {{ lane = 'east-out', speed_mps = 12 }} }},\n]"
    );
    from_text("column.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
}

#[test]
fn what_is_written_of_later_times_changes_nothing_before() {
    let steady = "{ kind = 'scripted', script = [{ speed_mps = 12.0 }] }";
    let braking = "{ kind = 'scripted', script = [{ speed_mps = 12.0 }, { from_s = 3.0, speed_mps = 0.0 }] }";
    let [at_three, at_six] = ["enters_s = 3.0", "enters_s = 6.0"];
    KINDS.par_iter().for_each(|kind| {
        let film = |driver: &str, enters: &str| film("column", column(driver, enters, kind));
        let usual = film(steady, at_six);
        are_equal_before(&format!("{kind}, a script"), [&usual, &film(braking, at_six)], 3.0);
        are_equal_before(&format!("{kind}, a departure"), [&usual, &film(steady, at_three)], 3.0);
    });
}
