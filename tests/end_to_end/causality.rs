//! Among people, no driver knows the future: what happens before a time does not depend on what is decided after it.

use interplay_planners::drivers::human::{self, Human};
use interplay_planners::drivers::idm::{self, Idm};
use interplay_planners::drivers::scripted::{self, Order, Scripted};
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, Input, Plan, PlanError, Scene};
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

/// A street whose leader follows a record.
const STOP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/streets2/rec-stop-44.toml");

/// When the decision changes \[s\].
const CHANGE_S: f64 = 4.0;
/// How long runs are watched after it \[s\].
const WATCHED_S: f64 = 1.6;

/// A street whose ego is of a kind.
fn street(name: &str, kind: &str) -> Scenario {
    let kind = format!("vehicle.ego.driver.kind=\"{kind}\"");
    authored(name, &[&kind, "expect={}", "counterfactual=[]"])
}

/// A person that wants half the speed of its goal.
#[derive(Debug)]
struct Unhurried(Human);

impl Drive for Unhurried {
    fn plan(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError> {
        let mut scene = scene.clone();
        scene.goal.target.speed_mps *= 0.5;
        self.0.plan(&scene, inferred_futures)
    }
}

/// What changes in a vehicle: it brakes for no reason, or has another style, goal or kind.
const CHANGES: [&str; 4] = ["braking", "style", "goal", "kind"];

fn change(simulation: &mut Simulation, vehicle: &str, what: &str) {
    let human = Human::new(human::Settings::default());
    let changed = match what {
        "braking" => {
            let order = Order { speed_mps: Some(0.0), acceleration_mps2: Some(4.0), ..Order::default() };
            simulation.drive_with(vehicle, Scripted::new(scripted::Settings { script: vec![order] }))
        }
        "style" => simulation.drive_with(vehicle, human),
        "goal" => simulation.drive_with(vehicle, Unhurried(human)),
        _ => simulation.drive_with(vehicle, Idm::new(idm::Settings::literature())),
    };
    changed.expect("a vehicle of the scenario");
}

/// The applied inputs of each vehicle while a run is watched.
fn inputs_of(mut simulation: Simulation) -> Vec<Vec<Input>> {
    let mut inputs = Vec::new();
    while simulation.time_s() < CHANGE_S + WATCHED_S
        && let Some(frame) = simulation.step().expect("the run goes on")
    {
        inputs.push(frame.vehicles.iter().map(|vehicle| vehicle.input).collect());
    }
    inputs
}

/// What each vehicle but the changed one does before it can have seen a change is the same without it. Which changes showed.
fn reacts_in_time(what: &str, scenario: &Scenario, changed: &str) -> [bool; CHANGES.len()] {
    let mut simulation = Simulation::new(scenario).expect("a scenario without fault");
    simulation.advance_to(CHANGE_S).expect("the run goes on");
    let moment = simulation.snapshot().expect("drivers that fork");
    let usual = inputs_of(simulation);
    let plan_s = scenario.step_s * scenario.ticks_per_plan as f64;
    let changes = scenario.vehicles.iter().position(|vehicle| vehicle.name == changed).expect("a vehicle");
    CHANGES.map(|what_changes| {
        let mut simulation = moment.resume().expect("a run that goes on");
        change(&mut simulation, changed, what_changes);
        let other = inputs_of(simulation);
        for (row, vehicle) in scenario.vehicles.iter().enumerate().filter(|(row, _)| *row != changes) {
            let blind_s = plan_s + vehicle.driver.reaction_s();
            let blind = (blind_s / scenario.step_s).round() as usize;
            for (tick, (a, b)) in usual.iter().zip(&other).enumerate().take(blind) {
                let time_s = scenario.step_s * tick as f64;
                assert_eq!(a[row], b[row], "{what}, {what_changes}: {} knew at {time_s} s", vehicle.name);
            }
        }
        usual.iter().zip(&other).any(|(a, b)| a[changes] != b[changes])
    })
}

#[test]
fn no_driver_reacts_to_a_change_before_it_can_have_seen_it() {
    let all: Vec<_> = STREETS.iter().flat_map(|street| KINDS.map(|kind| (street, kind))).collect();
    all.par_iter().for_each(|((name, changed), kind)| {
        let shown = reacts_in_time(&format!("{name}, {kind}"), &street(name, kind), changed);
        assert_eq!(shown, [true; CHANGES.len()], "{name}, {kind}: a change that shows nowhere");
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

/// What may be written of later times in the file of a column, and where nothing happens.
const STEADY: &str = "{ kind = 'scripted', script = [{ speed_mps = 12.0 }] }";
const ENTERS: &str = "enters_s = 6.0";
const GREEN_S: f64 = 6.0;

/// A street with an ego, a vehicle ahead whose driver is stated, a person behind the ego, one that enters, and a light that turns red.
fn column(driver: &str, enters: &str, green_s: f64, kind: &str) -> Scenario {
    let text = format!(
        "title = 'a column'\nshows = 'three cars'\nduration_s = 8\ndefaults = {{ class = 'car' }}\n\
         road = {{ kind = 'crossing' }}\n\
         light = [{{ name = 'west', lanes = ['west-in', 'east-in'], phases = [\
         {{ colour = 'green', duration_s = {green_s} }}, {{ colour = 'amber', duration_s = 3 }}, \
         {{ colour = 'red', duration_s = 30 }}] }}]\n\
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
    let section = "{ kind = 'scripted', script = [{ speed_mps = 12.0 }, { from_s = 3.0, speed_mps = 0.0 }] }";
    // It is there after 3 s.
    let trigger = "{ kind = 'scripted', script = [{ speed_mps = 12.0 }, \
                   { when = { vehicle = 'ahead', reaches = { lane = 'west-in', along_m = 81 } }, speed_mps = 0.0 }] }";
    let later = [
        ("a section", section, ENTERS, GREEN_S),
        ("a trigger", trigger, ENTERS, GREEN_S),
        ("a departure", STEADY, "enters_s = 3.0", GREEN_S),
        ("a light", STEADY, ENTERS, 3.0),
    ];
    KINDS.par_iter().for_each(|kind| {
        let film = |driver: &str, enters: &str, green_s: f64| film("column", column(driver, enters, green_s, kind));
        let usual = film(STEADY, ENTERS, GREEN_S);
        for (what, driver, enters, green_s) in later {
            are_equal_before(&format!("{kind}, {what}"), [&usual, &film(driver, enters, green_s)], 3.0);
        }
    });
}

#[test]
fn later_rows_of_a_record_change_nothing_before() {
    let rows = |after: &str, kind: &str| {
        let driver = format!("{{ kind = \"recorded\", points = [[0.0, 44.0, 1.75, 0.0, 20.0], {after}] }}");
        let kind = format!("vehicle.ego.driver={{ kind = \"{kind}\" }}");
        authored(STOP, &[&format!("vehicle.lead.driver={driver}"), &kind, "duration_s=8"])
    };
    KINDS.par_iter().for_each(|kind| {
        let [drives_on, brakes] = [
            "[3.0, 104.0, 1.75, 0.0, 20.0], [8.0, 204.0, 1.75, 0.0, 20.0]",
            "[3.0, 104.0, 1.75, 0.0, 20.0], [6.0, 134.0, 1.75, 0.0, 0.0], [8.0, 134.0, 1.75, 0.0, 0.0]",
        ]
        .map(|after| film("record", rows(after, kind)));
        are_equal_before(&format!("{kind}, a record"), [&drives_on, &brakes], 3.0);
    });
}
