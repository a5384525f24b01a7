//! Runs as scenarios of CommonRoad, with the motion of the ego as a solution.

use std::fs;
use std::path::{Path, PathBuf};

use interplay_scenarios::{ImportOptions, Registry, Scenario, import_commonroad};

use crate::command::{Outcome, contents, interplay, scratch};
use crate::trajectories::columns;

fn case(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/commonroad").join(file)
}

fn run(folder: &Path, scenario: &str, more: &[&str]) -> Outcome {
    let outcome = interplay(folder, &[&["run", scenario, "--no-record", "--export", "driven.xml"][..], more].concat());
    assert!(outcome.code.is_some_and(|code| code <= 1), "{scenario}: {}", outcome.stderr);
    outcome
}

/// The exported scenario, imported again.
fn imported(folder: &Path) -> Scenario {
    let text = fs::read_to_string(folder.join("driven.xml")).expect("written");
    let imported = import_commonroad("driven.xml", &text, &ImportOptions::default()).expect("a sound scenario");
    imported.resolve(Registry::standard()).unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
}

/// The states of a solution: x, y, steering angle, velocity, orientation and time.
fn solution(folder: &Path) -> Vec<[f64; 6]> {
    let text = fs::read_to_string(folder.join("driven.solution.xml")).expect("written");
    let value = |state: &str, tag: &str| {
        let (_, after) = state.split_once(&format!("<{tag}>")).expect("stated");
        after.split_once('<').expect("closed").0.parse::<f64>().expect("a number")
    };
    let states = text.split("<ksState>").skip(1);
    states
        .map(|state| ["x", "y", "steeringAngle", "velocity", "orientation", "time"].map(|tag| value(state, tag)))
        .collect()
}

/// The rear axle, the steering angle, the speed and the heading a time later, under even inputs: the model `KS2` by its equations.
fn integrated(state: [f64; 5], [steering_rate, acceleration]: [f64; 2], step_s: f64) -> [f64; 5] {
    const STEPS: usize = 200;
    let part_s = step_s / STEPS as f64;
    (0..STEPS).fold(state, |[x, y, steering, speed, heading], _| {
        let turned = heading + 0.5 * part_s * speed / WHEELBASE_M * steering.tan();
        [
            x + part_s * speed * turned.cos(),
            y + part_s * speed * turned.sin(),
            steering + part_s * steering_rate,
            speed + part_s * acceleration,
            heading + part_s * speed / WHEELBASE_M * (steering + 0.5 * part_s * steering_rate).tan(),
        ]
    })
}

const REAR_AXLE_M: f64 = 1.4227;
const WHEELBASE_M: f64 = 2.5789;

/// What the referee asks of a solution: from each state to the next the model comes within 2 cm and 0.03 rad.
fn assert_feasible(states: &[[f64; 6]], step_s: f64) {
    let axle = |[x, y, steering, speed, heading, _]: [f64; 6]| {
        [x - REAR_AXLE_M * heading.cos(), y - REAR_AXLE_M * heading.sin(), steering, speed, heading]
    };
    for pair in states.windows(2) {
        let [from, to] = [axle(pair[0]), axle(pair[1])];
        assert_eq!(pair[1][5] - pair[0][5], 1.0, "every step of time");
        let rate = ((to[2] - from[2]) / step_s).clamp(-0.4, 0.4);
        let reached = integrated(from, [rate, (to[3] - from[3]) / step_s], step_s);
        let away_m = (reached[0] - to[0]).hypot(reached[1] - to[1]);
        assert!(away_m < 0.02 && (reached[4] - to[4]).abs() < 0.03, "step {}: {away_m} m", pair[0][5]);
    }
}

/// Roads and planning problem stay as they are written, obstacles are those that were driven, and the ego's motion is feasible.
#[test]
fn an_imported_scenario_is_exported_with_the_driven_motion() {
    let folder = scratch("export-imported");
    let source = case("motorway.xml");
    run(&folder, &source.to_string_lossy(), &["--planner", "human", "--trajectories", "driven.csv"]);
    let [before, after] = [&source, &folder.join("driven.xml")].map(|path| fs::read_to_string(path).expect("there"));
    let between = |text: &str, from: &str, to: &str| {
        let begin = text.find(from).expect("stated");
        text[begin..text[begin..].find(to).expect("closed") + begin].to_owned()
    };
    for (from, to) in [("<lanelet id", "</lanelet>"), ("<planningProblem", "</planningProblem>")] {
        assert_eq!(between(&before, from, to), between(&after, from, to));
    }
    let scenario = imported(&folder);
    let table = columns(&folder.join("driven.csv"));
    for (row, name) in table["vehicle"].iter().enumerate().filter(|(_, name)| *name != "ego") {
        let record = scenario.vehicle(name).and_then(|vehicle| vehicle.driver.record()).expect("its id is kept");
        let number = |column: &str| table[column][row].parse::<f64>().expect("a number");
        let state = record.state_at(number("time_s")).expect("at every tick");
        assert!((state.x_m - number("x_m")).hypot(state.y_m - number("y_m")) < 1e-3, "{name} in row {row}");
    }
    assert_feasible(&solution(&folder), scenario.step_s);
}

/// Both files are in the coordinates of the imported map, however far it is from the origin.
#[test]
fn coordinates_moved_near_the_origin_are_moved_back_on_export() {
    let folder = scratch("export-utm");
    run(&folder, &case("tee-in-utm.xml").to_string_lossy(), &[]);
    assert!(solution(&folder).iter().all(|[x, y, ..]| x.abs() > 1e5 && y.abs() > 1e6));
    assert!(imported(&folder).vehicle("car-7").is_some());
}

/// Lanes of every form of road become lanelets on which the same vehicles drive, and the ego's way is a solution.
#[test]
fn authored_scenarios_become_commonroad_scenarios() {
    for scenario in ["roundabout/nice", "streets/crossing/3", "intersection/nice", "lane-change/front-nice"] {
        let folder = scratch("export-ours");
        let outcome = run(&folder, scenario, &["--set", "duration_s=3.0"]);
        let scenario = imported(&folder);
        assert!(scenario.network.is_some() && scenario.ego().is_some(), "{}", outcome.stderr);
        assert!(solution(&folder).len() > 5);
        assert_eq!(contents(&folder), ["driven.solution.xml", "driven.xml"]);
    }
}

/// A vehicle that has not entered the road yet has no row and no state.
#[test]
fn an_entering_vehicle_is_exported_from_its_entry_on() {
    let folder = scratch("export-later");
    run(&folder, "people/high-street", &["--set", "duration_s=10.0", "--trajectories", "driven.csv"]);
    let table = columns(&folder.join("driven.csv"));
    let row = table["vehicle"].iter().position(|name| name == "side-street").expect("it comes");
    let comes_s: f64 = table["time_s"][row].parse().expect("a number");
    assert!(comes_s > 7.99, "{comes_s}");
    let exported = imported(&folder);
    let later: Vec<f64> = exported.vehicles.iter().filter_map(|vehicle| vehicle.stay.enters_s).collect();
    assert!(later.len() == 1 && (later[0] - comes_s).abs() < 1e-6, "{later:?}");
}

#[test]
fn an_export_never_overwrites_an_input() {
    let folder = scratch("export-unharmed");
    let source = folder.join("source.xml");
    fs::copy(case("motorway.xml"), &source).expect("copied");
    fs::copy(case("motorway.xml"), folder.join("other.solution.xml")).expect("copied");
    let before = fs::read(&source).expect("there");
    for (scenario, target) in [("source.xml", "source.xml"), ("other.solution.xml", "other.xml")] {
        let outcome = interplay(&folder, &["run", scenario, "--no-record", "--export", target]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("would overwrite"), "{}", outcome.stderr);
    }
    let other_step = ["run", "source.xml", "--no-record", "--set", "step_s=0.05", "--export", "new.xml"];
    let outcome = interplay(&folder, &other_step);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("timeStepSize"), "{}", outcome.stderr);
    assert!(fs::read(&source).expect("there") == before && !folder.join("new.xml").exists());
}
