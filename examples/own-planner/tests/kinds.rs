//! The controller, the road and the observation of this crate.

use std::process::Command;

use interplay_scenarios::{ObstacleKind, Outline, Override, Registry, load};
use interplay_simulation::environment::{AgentView, Environment, EnvironmentSettings, ForeignView};
use own_planner::{BOLLARD, Headway, OneWay, Proportional};
use serde_json::Value;
use tempfile::tempdir;

const STREET: &str = "title = 'street'\nshows = 'a road of another crate'\nduration_s = 2.0\n\
    road = { kind = 'one-way', length_m = 200.0 }\n\
    [[vehicle]]\nname = 'ego'\nstart = { lane = 'through', along_m = 20.0, speed_mps = 10.0 }\n";

fn registry() -> Registry {
    let registry = Registry::default().with_controller::<Proportional>().expect("a new word");
    registry.with_road::<OneWay>().expect("a new word")
}

#[test]
fn a_scenario_with_a_custom_road_form_runs_and_is_written_back() {
    let registry = registry();
    let scenario = registry.from_text("street.toml", STREET, &[]).expect("sound");
    assert_eq!(scenario.road.lane_width_m(), 3.5, "the size of real cars");
    let again = registry.from_text("again.toml", &scenario.to_file().to_toml(), &[]).expect("sound");
    assert_eq!(again.road, scenario.road);
    let report = interplay_simulation::run::run("street", &scenario, Vec::new()).expect("it ends");
    assert!(report.collisions.is_empty());
    let long = Override::Set("road.length_m=9000".to_owned());
    let refused = registry.from_text("street.toml", STREET, &[long]).expect_err("too long");
    assert!(refused.faults()[0].message().contains("must be at most 5000"), "{}", refused.faults()[0].message());
    assert!(interplay_scenarios::from_text("street.toml", STREET, &[]).is_err(), "it is not one of Interplay's");
}

#[test]
fn a_custom_obstacle_kind_has_its_usual_size() {
    let registry = registry().with_obstacle(BOLLARD).expect("a new word");
    let text = format!("{STREET}[[obstacle]]\nname = 'post'\nkind = 'bollard'\nlane = 'through'\nalong_m = 90.0\n");
    let scenario = registry.from_text("street.toml", &text, &[]).expect("sound");
    let form = scenario.vehicles.iter().find_map(|vehicle| vehicle.obstacle.clone()).expect("an obstacle");
    assert_eq!(
        (form.kind, form.outline),
        (ObstacleKind::Declared("bollard".to_owned()), Outline::Circle { radius_m: 0.1 })
    );
    let again = registry.from_text("again.toml", &scenario.to_file().to_toml(), &[]).expect("sound");
    assert_eq!(again.vehicles.len(), scenario.vehicles.len());
    let without = self::registry().from_text("street.toml", &text, &[]).expect_err("not one of Interplay's");
    assert!(without.faults()[0].message().contains("bollard"), "{}", without.faults()[0].message());
}

#[test]
fn the_command_runs_a_building_with_a_custom_controller() {
    let folder = tempdir().expect("a folder");
    let program = env!("CARGO_BIN_EXE_own-planner");
    let set = "controller={ kind = 'proportional', gain_kw_per_k = 2.0 }";
    let words = ["run", "building/four-room-pid", "--set", set, "--no-record", "--json"];
    let output = Command::new(program).args(words).current_dir(folder.path()).output().expect("it starts");
    // The scenario expects what a PID controller does.
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
    assert_eq!(report["building"]["controller"], "proportional", "{report}");
}

#[test]
fn an_agent_receives_a_custom_observation() {
    let observations = vec![AgentView::Foreign(ForeignView::new(Headway))];
    let settings = EnvironmentSettings { observations, ..EnvironmentSettings::default() };
    let scenario = load("lane-change/front-nice", &[]).expect("authored");
    let mut environment = Environment::new(&scenario, &settings).expect("sound");
    environment.reset(Some(1)).expect("an episode");
    let mut seen = [-1.0];
    environment.observe(0, &mut seen).expect("one number");
    assert!((0.0..=1.0).contains(&seen[0]), "{seen:?}");
}
