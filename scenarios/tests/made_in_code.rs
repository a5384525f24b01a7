//! Scenarios made in code: their defaults, and the paths in their errors.

use interplay_scenarios::{
    Fault, LaneConfig, LaneNetwork, LoadError, Road, Scenario, ScenarioFile, StartConfig, Stated, VehicleClass,
    VehicleConfig, from_text,
};
use serde_json::{Value as Json, json};

fn vehicle(name: &str, along_m: f64) -> VehicleConfig {
    VehicleConfig::new(name, StartConfig::in_lane("main", along_m, 10.0))
}

fn network() -> ScenarioFile {
    let lane = |name: &str, from_m: f64| LaneConfig::through(name, &[[from_m, 0.0], [from_m + 100.0, 0.0]], 3.5);
    let main = LaneConfig { successors: vec!["next".to_owned()], ..lane("main", 0.0) };
    ScenarioFile {
        road: Some(Road::Network(LaneNetwork { lanes: vec![main, lane("next", 100.0)] }).into()),
        vehicles: vec![vehicle("ego", 10.0), vehicle("front", 40.0)],
        ..ScenarioFile::new("A network", "Two vehicles on lanes with names")
    }
}

fn of_json(table: Json) -> Result<Scenario, LoadError> {
    ScenarioFile::from_json(table.as_object().expect("a table"))?.resolve()
}

#[test]
fn a_network_of_lanes_is_built_and_written_out() {
    let scenario = network().resolve().expect("sound");
    let lanes = |scenario: &Scenario| scenario.vehicles[0].route.legs.iter().map(|leg| leg.lane.clone()).collect();
    let route: Vec<String> = lanes(&scenario);
    assert_eq!(route, ["main", "next"], "there is only one way");
    assert_eq!(scenario.network.as_ref().map(|network| network.lanes().len()), Some(2));
    assert_eq!(from_text("written.toml", &scenario.to_file().to_toml(), &[]).expect("what was written"), scenario);
    assert_eq!(scenario.to_file().resolve().expect("what was resolved"), scenario);
}

/// A text and the same values in code describe the same scenario, and a file that was read may be changed in code.
#[test]
fn a_scenario_made_in_code_equals_its_text() {
    let text = "title = 'A'\nshows = 'B'\nroad = { kind = 'crossing' }\n[[vehicle]]\nname = 'ego'\nclass = 'van'\n\
                start = { lane = 'west-in', along_m = 20, speed_mps = 8 }\nlimits.speed_max_mps = 12.0\ngoal.lane = 'east-out'";
    let mut ego = VehicleConfig::new("ego", StartConfig::in_lane("west-in", 20.0, 8.0));
    ego.class = Some(VehicleClass::Van);
    ego.limits = Some(Stated::default().with("speed_max_mps", 12.0));
    ego.goal.lane = Some("east-out".into());
    let made =
        ScenarioFile { road: Some(Stated::kind("crossing")), vehicles: vec![ego], ..ScenarioFile::new("A", "B") };
    let read = from_text("crossing.toml", text, &[]).expect("sound");
    assert_eq!(made.resolve().expect("sound"), read);
    assert_eq!((read.vehicles[0].limits.speed_max_mps, read.vehicles[0].body.width_m), (12.0, 2.0));
    let mut file = ScenarioFile::load("lane-change/front-nice", &[]).expect("authored");
    file.duration_s = Some(3.0);
    assert_eq!(file.resolve().expect("sound").tick_count(), 30);
    let largest = ScenarioFile { seed: Some(u64::MAX), ..made };
    assert_eq!(from_text("written.toml", &largest.to_toml(), &[]).expect("sound").seed, u64::MAX);
}

#[test]
fn a_table_of_json_may_extend_an_authored_scenario() {
    let table = json!({ "extends": "lane-change/front-nice", "title": "Mine", "vehicle": [{ "name": "ego", "goal": { "speed_mps": 0.9 } }] });
    let scenario = of_json(table).expect("sound");
    assert_eq!((scenario.title.as_str(), scenario.vehicles.len()), ("Mine", 3));
    assert_eq!(scenario.ego().and_then(|ego| ego.goal.speed_mps), Some(0.9));
}

/// Each error names the path of the key and shows its value.
#[test]
fn errors_name_the_path_of_the_key() {
    let first = |result: Result<Scenario, LoadError>| {
        let error = result.expect_err("it is wrong");
        let fault: &Fault = &error.faults()[0];
        assert_eq!(fault.line_and_column(), None, "a text does not exist: {fault}");
        (fault.file().unwrap_or_default().to_owned(), fault.message().to_owned())
    };
    let of = |change: &dyn Fn(&mut ScenarioFile)| {
        let mut file = network();
        change(&mut file);
        first(file.resolve())
    };
    let cases = [
        (of(&|file| file.vehicles[1].start.lane = Some("mian".into())), "vehicle.front.start.lane", "`mian`"),
        (of(&|file| file.vehicles[1].start.speed_mps = f64::NAN), "vehicle.front.start.speed_mps", "number"),
        (of(&|file| file.duration_s = Some(0.0)), "duration_s", "at least 0.001"),
        (
            of(&|file| file.vehicles[0].driver = Some(Stated::kind("negotiaton"))),
            "vehicle.ego.driver.kind",
            "negotiaton",
        ),
        (
            of(&|file| file.vehicles[0].driver = Some(Stated::kind("human").with("stile", "nice"))),
            "vehicle.ego.driver.stile",
            "`stile`",
        ),
        (of(&|file| file.vehicles.clear()), "scenario", "nothing to simulate"),
        (first(of_json(json!({ "title": "A", "shows": "B", "vehicles": [] }))), "vehicles", "unknown key"),
    ];
    for ((path, message), expected_path, fragment) in cases {
        assert!(path == expected_path && message.contains(fragment), "{path}: {message}");
    }
}
