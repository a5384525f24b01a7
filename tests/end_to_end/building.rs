//! Buildings: the authored ones do what they say, runs repeat bit for bit, bad input is located, and a known truth is found.

use std::path::{Path, PathBuf};
use std::{env, fs};

use interplay_building::identify::synthetic_classroom::{
    CAPACITY_KJ_PER_K, Classroom, OUTDOOR_K_PER_KW, ROOM_K_PER_KW,
};
use interplay_scenarios::embedded;
use serde_json::{Map, Value, json};

use crate::command::{Outcome, contents, interplay, scratch};
use crate::film::{authored, film};

/// Four days of the testbed without fault, to be spoilt.
const SOUND: &str = r#"
title = "Two rooms"
shows = "Nothing wrong"
iterations = 2

[building]
step_s = 1800.0

[[building.zone]]
name = "office"
limit_kw = 1.5

[[building.zone]]
name = "store"

[[building.wall]]
between = ["office", "store"]
resistance_k_per_kw = 62.5

[[building.wall]]
between = ["office", "ambient"]
resistance_k_per_kw = 31.25

[setpoints]
occupied_c = [24.0]

[controller]
kind = "pid"
"#;

fn run_text(test: &str, text: &str, more: &[&str]) -> Outcome {
    let folder = scratch(test);
    fs::write(folder.join("my.toml"), text).expect("a scratch file can be written");
    interplay(&folder, &[&["run", "my.toml", "--no-record"], more].concat())
}

#[track_caller]
fn refused(outcome: &Outcome, pieces: &[&str]) {
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert_eq!(outcome.stdout, "");
    for piece in pieces {
        assert!(outcome.stderr.contains(piece), "`{piece}` is not said in:\n{}", outcome.stderr);
    }
}

/// Runs [`SOUND`] with texts replaced, and holds the outcome to the contract of bad input.
#[track_caller]
fn spoilt(test: &str, sound: &str, spoilt: &str, pieces: &[&str]) {
    assert!(SOUND.contains(sound), "{sound}");
    refused(&run_text(test, &SOUND.replace(sound, spoilt), &[]), pieces);
}

fn costs(report: &Value) -> Vec<f64> {
    let days = report["building"]["iterations"].as_array().expect("a list");
    days.iter().map(|day| day["cost"].as_f64().expect("a number")).collect()
}

#[test]
fn the_report_of_a_building_has_the_documented_keys() {
    let report =
        interplay(&scratch("building-report"), &["run", "building/four-room-ilc", "--no-record", "--json"]).json();
    for key in ["vehicles", "collisions", "order", "min_gap_m", "smallest_gap", "right_of_way", "phase_digests"] {
        assert!(report.get(key).is_none(), "{key} without vehicles");
    }
    let days = report["building"]["iterations"].as_array().expect("a list");
    assert_eq!((days.len(), &report["simulated_s"]), (10, &json!(864_000.0)));
    let keys =
        "cost tracking_rmse_c energy_kwh discomfort_k_h input_violation_kw peak_kw regret spectral_radius design_s";
    for key in keys.split_whitespace() {
        assert!(days.iter().all(|day| day[key].is_number()), "{key}");
    }
    assert!(days.iter().all(|day| day["regret"].as_f64() > Some(-1e-6)), "no design is cheaper than the optimum");
    let driving =
        interplay(&scratch("building-none"), &["run", "--set", "duration_s=2", "--no-record", "--json"]).json();
    assert!(driving.get("building").is_none() && driving.get("vehicles").is_some());
}

/// The expectations of learning are those that a controller without memory fails.
#[test]
fn controllers_that_do_not_learn_fail_the_expectations_of_learning() {
    let arguments = ["run", "building/four-room-ilc", "--set", "controller.kind=pid", "--no-record", "--json"];
    let outcome = interplay(&scratch("building-no-memory"), &arguments);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    let report = outcome.json();
    let failed = report["expectations"].as_array().expect("a list").iter().filter(|one| one["passed"] == false);
    let failed: Vec<&str> = failed.filter_map(|one| one["what"].as_str()).collect();
    assert!(failed.contains(&"building.cost_at_most_share_of_first"), "{failed:?}");
    assert!(failed.contains(&"building.tracking_rmse_c_at_most"), "{failed:?}");
}

/// When every day is the same, plain learning converges: the cost falls every day.
#[test]
fn learning_costs_never_rise_on_identical_days() {
    let folder = scratch("building-same-days");
    let same = "extends = 'building/four-room-ilc'\niterations = 8\n[weather]\nkind = 'synthetic'\nforecast.kind = 'exact'\n\
        climate = { day_deviation_k = 0, amplitude_deviation_k = 0, storm_probability = 0, noise_deviation_k = 0 }\n\
        [occupancy.deviation]\nleast_bias = 0\ngreatest_bias = 0\nscatter = 0\nshift_h = 0\nmeeting_probability = 0\n\
        noise_kw = 0\n[expect.building]\nafter_iterations = 0\ncost_at_most_share_of_first = 1.0\n\
        tracking_rmse_c_at_most = 10.0\ndiscomfort_k_h_at_most = 100.0\n";
    for (expected, code) in [(true, 0), (false, 1)] {
        fs::write(folder.join("my.toml"), format!("{same}cost_never_rises = {expected}\n")).expect("written");
        let outcome = interplay(&folder, &["run", "my.toml", "--no-record", "--json"]);
        let costs = costs(&outcome.json());
        assert_eq!(outcome.code, Some(code), "{costs:?}");
        assert!(costs[7] < 0.05 * costs[0], "{costs:?}");
    }
}

#[test]
fn a_clairvoyant_regrets_nothing() {
    let arguments = ["run", "building/four-room-pid", "--set", "controller.kind=clairvoyant", "--no-record", "--json"];
    let report = interplay(&scratch("building-clairvoyant"), &arguments).json();
    for day in report["building"]["iterations"].as_array().expect("a list") {
        let regret = day["regret"].as_f64().expect("known");
        assert!(regret.abs() < 1e-3, "{regret}");
    }
}

/// Digests of whole runs, the same on every machine. `INTERPLAY_BLESS=1` renews them.
#[test]
fn golden_digests_of_buildings() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/buildings.json");
    let found: Map<String, Value> = embedded()
        .iter()
        .filter(|file| file.name.starts_with("building/"))
        .map(|file| {
            let [one, other] = [(); 2].map(|()| film(file.name, authored(file.name, &[])).report);
            let [digests, again] = [&one, &other].map(|run| json!(run.building.as_ref().expect("a building").digests));
            assert_eq!(digests, again, "{} is not the same twice", file.name);
            assert_eq!(json!(one.digest), digests["balance"]);
            (file.name.to_owned(), digests)
        })
        .collect();
    if env::var_os("INTERPLAY_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, format!("{:#}\n", json!(found))).expect("golden files can be written");
    }
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let wanted: Map<String, Value> = serde_json::from_str(&text).expect("a golden file is JSON");
    for (name, digests) in &found {
        assert_eq!(Some(digests), wanted.get(name), "{name}: if it is meant, INTERPLAY_BLESS=1");
    }
    assert_eq!(found.len(), wanted.len(), "a scenario is gone: if it is meant, INTERPLAY_BLESS=1");
}

#[test]
fn days_of_a_building_depend_on_the_seed_and_not_on_the_process() {
    let digest = |seed: &str| {
        let arguments = ["run", "building/four-room-pid", "--no-record", "--json", "--seed", seed];
        interplay(&scratch(&format!("building-seed-{seed}")), &arguments).json()["digest"].clone()
    };
    let here = film("here", authored("building/four-room-pid", &["seed=3"])).report.digest;
    assert_eq!(digest("3"), json!(here));
    assert_ne!(digest("3"), digest("4"));
}

/// Heat brought in, warmed by people and flowing through walls is what the temperatures say, at every step: the frames
/// alone give the next temperature of the exact model.
#[test]
fn frames_of_a_building_cover_each_day_from_midnight_to_midnight() {
    let film = film("building/four-room-ilc", authored("building/four-room-ilc", &[]));
    assert_eq!(film.frames.len(), 480);
    let steps: Vec<_> = film.frames.iter().map(|frame| frame.building.as_ref().expect("a step")).collect();
    for pair in steps.windows(2) {
        for (before, after) in pair[0].zones.iter().zip(&pair[1].zones) {
            assert_eq!(before.next_c, after.temperature_c);
            assert_eq!(before.heat_kw, before.requested_kw.clamp(-2.0, 2.0));
        }
    }
    let ends: Vec<(usize, usize)> =
        steps.iter().filter(|step| step.figures.is_some()).map(|step| (step.day, step.step)).collect();
    assert_eq!(ends, (0..10).map(|day| (day, 47)).collect::<Vec<_>>());
}

/// Vehicles and a building, each on its own clock; neither changes the other.
#[test]
fn vehicles_and_a_building_run_side_by_side() {
    let text = "extends = 'lane-change/front-nice'\nduration_s = 1.0\niterations = 1\n[expect]\ncompletes = []\n\
        order = ['front', 'ego']\n[building]\npreset = 'testbed'\nstep_s = 900\n\
        [setpoints]\noccupied_c = [24.0, 25.0, 26.0, 27.0]\n";
    let both = run_text("building-beside", text, &["--json"]).json();
    let alone = ["run", "--set", "duration_s=1", "--set", "expect.completes=[]", "--no-record", "--json"];
    let alone = interplay(&scratch("building-not-beside"), &alone).json();
    let house = authored("building/four-room-pid", &["iterations=1", "building.step_s=900", "expect.building={}"]);
    let house = json!(film("house", house).report);
    assert_eq!(both["phase_digests"], alone["phase_digests"]);
    assert_eq!(both["building"]["digests"], house["building"]["digests"]);
    assert_eq!(both["simulated_s"], 86_400.0);
    assert_ne!(both["digest"], alone["digest"]);
    let printed = run_text("building-beside-words", text, &[]).stdout;
    assert!(printed.contains("order at the end") && printed.contains("4 zones, controller pid"), "{printed}");
}

#[test]
fn a_run_of_a_building_writes_a_recording() {
    let folder = scratch("building-recorded");
    let outcome = interplay(&folder, &["run", "building/four-room-ilc", "--set", "iterations=3"]);
    let said = &outcome.stderr;
    let begin = "recorded to recordings/building/four-room-ilc.rrd (`--no-record` writes none); to open it: ";
    assert!(said.starts_with(begin), "{said}");
    assert!(said.ends_with(" view recordings/building/four-room-ilc.rrd\n"), "{said}");
    let bytes = fs::read(folder.join("recordings/building/four-room-ilc.rrd")).expect("there is a recording");
    for piece in ["/building/plan/rooms", "/building/zone/4/temperature", "/building/iteration/cost", "iteration"] {
        assert!(bytes.windows(piece.len()).any(|window| window == piece.as_bytes()), "{piece}");
    }
}

#[test]
fn the_reference_file_of_the_spoilt_buildings_is_valid() {
    assert_eq!(run_text("building-sound", SOUND, &[]).code, Some(0));
}

#[test]
fn unconnected_zones_are_allowed_with_a_note() {
    let apart = SOUND.replace(r#"["office", "store"]"#, r#"["store", "ambient"]"#);
    let outcome = run_text("building-apart", &apart, &[]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let said = "note: no heat passes between (`office`) and (`store`)";
    assert!(outcome.stdout.contains(said), "{outcome:?}");
    let folder = scratch("building-apart-checked");
    fs::write(folder.join("my.toml"), apart).expect("a scratch file can be written");
    let checked = interplay(&folder, &["check", "my.toml"]);
    assert!(checked.stdout.starts_with("ok  my.toml\n    makes ") && checked.stdout.contains(said), "{checked:?}");
}

#[test]
fn spoilt_buildings_are_refused_at_the_spoilt_line() {
    let wrong_unit = SOUND.replace("1800.0", "1800.0\nmethod = \"euler\"").replace("31.25", "0.5208");
    refused(&run_text("building-unit", &wrong_unit, &[]), &["my.toml:8", "the largest stable step is", "K/kW"]);
    let cases = [
        (
            "zero",
            "62.5",
            "0.0",
            &["my.toml:18:23", "`building.wall.0.resistance_k_per_kw` must be at least 0.000001"][..],
        ),
        ("itself", r#"["office", "store"]"#, r#"["office", "office"]"#, &["my.toml:17", "on both sides"]),
        ("unknown", r#""ambient"]"#, r#""ambeint"]"#, &["my.toml:21", "`ambeint`, which is not a zone", "`ambient`"]),
        ("twice", "\"store\"\n\n[[building.wall]]", "\"office\"\n\n[[building.wall]]", &["my.toml:14", "two zones"]),
        ("step", "1800.0", "1700.0", &["my.toml:7:10", "does not divide a day"]),
        ("key", "limit_kw", "limit_w", &["my.toml:11:1", "unknown key `limit_w`", "it is called `limit_kw` here"]),
        ("negative", "limit_kw = 1.5", "limit_kw = -1.5", &["my.toml:11:12", "must be at least 0, not -1.5"]),
        ("counts", "[24.0]", "[24.0, 25.0, 26.0]", &["my.toml:25", "3 temperatures for 2 zones"]),
        ("kind", "\"pid\"", "\"pdi\"", &["my.toml:28:8", "did you mean `pid`"]),
        (
            "gain",
            "\"pid\"",
            "\"pid\"\nproportional_kw_per_k = -1.0",
            &["my.toml:29:25", "`controller.proportional_kw_per_k`", "at least 0"],
        ),
        ("both", "step_s = 1800.0", "preset = \"testbed\"", &["my.toml", "states both `preset` and `zone`"]),
        ("driving", "iterations = 2", "duration_s = 2.0", &["my.toml:4", "there are no vehicles", "iterations"]),
    ];
    for (test, sound, bad, pieces) in cases {
        spoilt(&format!("building-{test}"), sound, bad, pieces);
    }
    let without =
        "title = 'a'\nshows = 'b'\nvehicle = [{ name = 'a', start = { x_m = 0, y_m = 0.2, speed_mps = 1 } }]\n";
    let text = format!("iterations = 3\n{without}");
    refused(&run_text("building-none-there", &text, &[]), &["my.toml:1", "there is no building"]);
    refused(&run_text("building-nothing", "title = 'a'\nshows = 'b'", &[]), &["nothing to simulate"]);
}

/// A week of weather, two lines of it spoilt in turn.
#[test]
fn weather_files_are_found_relative_to_the_scenario_and_their_faults_located() {
    let folder = scratch("building-epw");
    let july = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/weather/tropical-july.epw"));
    let july = july.expect("the authored weather");
    fs::create_dir(folder.join("weather")).expect("a folder can be made");
    let scenario = format!("{SOUND}\n[weather]\nkind = \"epw\"\nfile = \"weather/my.epw\"\n");
    fs::write(folder.join("my.toml"), &scenario).expect("written");
    let run = |weather: &str| {
        fs::write(folder.join("weather/my.epw"), weather).expect("written");
        interplay(folder.parent().expect("above"), &["run", "building-epw/my.toml", "--no-record"])
    };
    assert_eq!(run(&july).code, Some(0), "{:?}", run(&july));
    let lines: Vec<&str> = july.lines().collect();
    let cut = lines[..100].join("\n");
    refused(&run(&cut), &["weather/my.epw:100", "with 92 rows", "weather.file"]);
    refused(&run(&july.replacen(",27.0,", ",warm,", 1)), &["weather/my.epw:9", "`warm`, not a number"]);
    refused(&run("time,T\n0,1\n"), &["weather/my.epw:1", "begins with `LOCATION,`"]);
    refused(&run(""), &["my.epw", "EPW"]);
    fs::remove_file(folder.join("weather/my.epw")).expect("it was there");
    let missing = interplay(&folder, &["run", "my.toml", "--no-record"]);
    refused(&missing, &["my.toml:32:8", "cannot read `weather/my.epw`", "relative to the current folder"]);
    let long = interplay(&folder, &["run", "building/epw-weather", "--set", "iterations=40", "--no-record"]);
    refused(&long, &["covers 24 days", "`iterations`"]);
    let day = interplay(&folder, &["run", "building/epw-weather", "--set", "weather.day=40", "--no-record"]);
    refused(&day, &["weather.day", "at most 31"]);
}

/// A folder with the telemetry of a simulated classroom and its mapping. The classroom lives in steps, by forward Euler.
fn classroom(test: &str) -> PathBuf {
    let folder = scratch(test);
    let telemetry = Classroom::default().simulate();
    fs::write(folder.join("room.csv"), telemetry.to_csv()).expect("written");
    let mut mapping = telemetry.mapping();
    mapping.identify.method = interplay_building::identify::Estimator::PredictionError;
    mapping.identify.discretisation = interplay_building::discretise::Discretisation::Euler;
    let mapping = toml::to_string(&mapping).expect("plain data");
    fs::write(folder.join("room.toml"), mapping).expect("written");
    folder
}

#[test]
fn identification_recovers_a_known_truth() {
    let folder = classroom("identify-truth");
    let outcome = interplay(&folder, &["identify", "room.csv", "--json"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let report = outcome.json();
    let physical = report["zones"][0]["physical"].as_array().expect("a list");
    for (name, truth) in [
        ("heat capacity", CAPACITY_KJ_PER_K),
        ("resistance to outdoor", OUTDOOR_K_PER_KW),
        ("resistance to room-b", ROOM_K_PER_KW),
    ] {
        let found = physical.iter().find(|quantity| quantity["name"] == name).unwrap_or_else(|| panic!("no {name}"));
        let [value, error] = ["value", "standard_error"].map(|key| found[key].as_f64().expect("determined"));
        assert!((value - truth).abs() < 3.0 * error, "{name}: {value} ± {error}, in truth {truth}");
        assert!(error < 0.25 * truth, "{name}: {value} ± {error}");
    }
}

#[test]
fn identify_prints_a_table_and_draws_plots() {
    let folder = classroom("identify-plots");
    let outcome = interplay(&folder, &["identify", "room.csv"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let pieces = ["what is known", "heat capacity", "kJ/K", "24.00 h ahead", "--details"];
    assert!(pieces.iter().all(|piece| outcome.stdout.contains(piece)), "{}", outcome.stdout);
    assert!(outcome.stdout.lines().count() <= 40, "{}", outcome.stdout);
    let outcome = interplay(&folder, &["identify", "room.csv", "--details", "--out", "plots/new"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    for piece in ["zone classroom", "heat capacity", "kJ/K", "identified", "Ljung-Box", "free runs of 24 h"] {
        assert!(outcome.stdout.contains(piece), "{piece}: {}", outcome.stdout);
    }
    let plots = contents(&folder.join("plots/new"));
    let wanted = ["autocorrelation.png", "autocorrelation.svg", "fit.png", "fit.svg", "residuals.png", "residuals.svg"];
    assert_eq!(plots, wanted.map(|name| format!("1-classroom-{name}")));
    for name in plots {
        let bytes = fs::read(folder.join("plots/new").join(&name)).expect("it can be read");
        let whole = if name.ends_with("svg") { bytes.ends_with(b"</svg>\n") } else { bytes.starts_with(b"\x89PNG") };
        assert!(whole && bytes.len() > 5000, "{name}: {} bytes", bytes.len());
    }
    fs::write(folder.join("file"), "kept").expect("written");
    assert_eq!(interplay(&folder, &["identify", "room.csv", "--out", "file/below"]).code, Some(3));
}

#[test]
fn spoilt_telemetry_is_refused_at_the_spoilt_line() {
    let folder = classroom("identify-spoilt");
    let table = fs::read_to_string(folder.join("room.csv")).expect("it was written");
    let mapping = fs::read_to_string(folder.join("room.toml")).expect("it was written");
    let mapping = mapping.replace("gaps = \"split\"", "gaps = \"refuse\"");
    fs::write(folder.join("room.toml"), &mapping).expect("written");
    let lines: Vec<&str> = table.lines().collect();
    let spoilt = |table: &str, pieces: &[&str]| {
        fs::write(folder.join("room.csv"), table).expect("written");
        refused(&interplay(&folder, &["identify", "room.csv"]), pieces);
    };
    spoilt("", &["room.csv", "the table is empty"]);
    spoilt(&[&lines[..50], &lines[60..]].concat().join("\n"), &["room.csv:51:1", "there is a gap", "time.gaps"]);
    let mut fields: Vec<&str> = lines[7].split(',').collect();
    fields[5] = "warm";
    let text = fields.join(",");
    spoilt(
        &[&lines[..7], &[text.as_str()], &lines[8..]].concat().join("\n"),
        &["room.csv:8:", "`warm`", "not a number"],
    );
    spoilt("a,b\n1,2\n3,4\n", &["room.csv:1", "not in the header"]);
    fs::write(folder.join("room.csv"), &table).expect("written");
    let mapped = |mapping: &str, pieces: &[&str]| {
        fs::write(folder.join("room.toml"), mapping).expect("written");
        refused(&interplay(&folder, &["identify", "room.csv"]), pieces);
    };
    mapped(&mapping.replace("step_s", "step_min"), &["room.toml:", "unknown key `step_min` in `time`", "`step_s`?"]);
    mapped(&mapping.replace("\"kw\"", "\"kilowatt\""), &["room.toml:", "cannot be `kilowatt`"]);
    let mut numbered = mapping.lines().enumerate();
    let (line, bandwidth) = numbered.find(|(_, line)| line.starts_with("bandwidth_h = ")).expect("it is written");
    let place = format!("room.toml:{}:15: ", line + 1);
    mapped(&mapping.replace(bandwidth, "bandwidth_h = 0.001"), &[&place, "`identify.bandwidth_h` is 0.001"]);
    fs::remove_file(folder.join("room.toml")).expect("it was there");
    refused(&interplay(&folder, &["identify", "room.csv"]), &["room.toml", "--mapping"]);
    refused(&interplay(&folder, &["identify", "none.csv"]), &["none.csv"]);
}
