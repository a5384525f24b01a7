//! From measurements to a run: a house with a heavy wall is simulated, identified, written as a scenario, and run.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use interplay_building::discretise::Model;
use interplay_building::network::{AMBIENT, Network, Wall, Zone};
use interplay_common::random::Random;
use interplay_scenarios::load;
use interplay_simulation::frame::BuildingFrame;
use serde_json::Value;

use crate::command::{interplay, scratch};
use crate::film::film;

const STEP_S: f64 = 900.0;
/// Outdoors [kW/K], and all capacities [kJ/K].
const CONDUCTANCE: f64 = 0.2;
const CAPACITY: f64 = 20_000.0;

const MAPPING: &str = "walls = [['house', 'outdoor']]\n\
    [time]\ncolumn = 'time'\nformat = 'seconds'\nstep_s = 900.0\n\
    [[boundary]]\nname = 'outdoor'\ntemperature = 'out'\nhold = 'zero-order'\n\
    [[zone]]\nname = 'house'\ntemperature = 'in'\nheat = [{ kind = 'power', column = 'heat', unit = 'kw' }]\n";

/// A folder with two weeks of the house and their mapping.
fn house(test: &str) -> PathBuf {
    let folder = scratch(test);
    let zone = Zone { capacity_kj_per_k: 0.15 * CAPACITY, ..Zone::named("house") };
    let wall = Wall::new("house", AMBIENT, 1.0 / CONDUCTANCE).with_capacity_kj_per_k(0.85 * CAPACITY);
    let network = Network::new(&[zone], &[Wall { mass_position: Some(0.25), ..wall }]).expect("sound");
    let model = Model::exact(&network, STEP_S).expect("sound");
    let mut random = Random::new(3, 9);
    let (mut state, mut on) = (vec![20.0, 16.0], false);
    let mut table = String::from("time,in,out,heat\n");
    for row in 0..14 * 96 {
        let hour = f64::from(row) * STEP_S / 3600.0;
        on ^= random.chance(STEP_S / 3600.0 / 3.0);
        let outdoor = 5.0 + 4.0 * (hour * std::f64::consts::TAU / 24.0).sin() + 3.0 * (hour * 0.061).sin();
        let heat = if on { 5.0 } else { 0.3 };
        let inside = state[0] + random.normal(0.0, 0.03);
        table.push_str(&format!("{},{inside:.4},{outdoor:.6},{heat}\n", f64::from(row) * STEP_S));
        model.step(&mut state, &[heat], outdoor, &[random.normal(0.0, 0.1)]);
    }
    fs::write(folder.join("house.csv"), table).expect("written");
    fs::write(folder.join("house.toml"), MAPPING).expect("written");
    folder
}

/// The same folder with the sun of two clear and two dull days in turn on the wall, 1.5 m² of it.
fn sunny_house(test: &str) -> PathBuf {
    let folder = scratch(test);
    let zone = Zone { capacity_kj_per_k: 0.15 * CAPACITY, ..Zone::named("house") };
    let wall = Wall::new("house", AMBIENT, 1.0 / CONDUCTANCE).with_capacity_kj_per_k(0.85 * CAPACITY);
    let wall = Wall { mass_position: Some(0.25), solar_aperture_m2: 1.5, ..wall };
    let network = Network::new(&[zone], &[wall]).expect("sound");
    let model = Model::exact(&network, STEP_S).expect("sound");
    let mut random = Random::new(4, 9);
    let (mut state, mut on) = (vec![20.0, 16.0], false);
    let mut table = String::from("time,in,out,heat,sun\n");
    for row in 0..14 * 96 {
        let hour = f64::from(row) * STEP_S / 3600.0;
        on ^= random.chance(STEP_S / 3600.0 / 3.0);
        let outdoor = 5.0 + 4.0 * (hour * std::f64::consts::TAU / 24.0).sin() + 3.0 * (hour * 0.061).sin();
        let height = ((hour % 24.0 - 7.0) * std::f64::consts::PI / 10.0).sin();
        let clear = if hour % 96.0 < 48.0 { 700.0 } else { 100.0 };
        let sun = if (7.0..17.0).contains(&(hour % 24.0)) { (clear * height).max(0.0) } else { 0.0 };
        let heat = if on { 5.0 } else { 0.3 };
        let inside = state[0] + random.normal(0.0, 0.03);
        table.push_str(&format!("{},{inside:.4},{outdoor:.6},{heat},{sun:.3}\n", f64::from(row) * STEP_S));
        let mut gains_kw = network.solar_gains_kw(sun);
        gains_kw[0] += random.normal(0.0, 0.05);
        model.step(&mut state, &[heat], outdoor, &gains_kw);
    }
    let solar = "solar = { column = 'sun', unit = 'w-per-m2', hold = 'zero-order' }\n";
    fs::write(folder.join("house.csv"), table).expect("written");
    fs::write(folder.join("house.toml"), format!("{MAPPING}{solar}")).expect("written");
    folder
}

fn written(path: &Path) -> toml::Table {
    fs::read_to_string(path).expect("written").parse().expect("TOML")
}

#[test]
fn an_identified_house_runs_under_any_controller() {
    let folder = house("identify-scenario");
    let plain = interplay(&folder, &["identify", "house.csv", "--scenario", "plain.toml"]);
    assert_eq!(plain.code, Some(0), "{plain:?}");
    assert!(
        written(&folder.join("plain.toml"))["building"].get("believed").is_none(),
        "the controller believes the estimate"
    );
    let arguments = ["identify", "house.csv", "--details", "--scenario", "found.toml", "--believe-upper-ends"];
    let outcome = interplay(&folder, &arguments);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    for piece in ["air, wall to outdoor", "log-likelihood", "conductance to outdoor", "mean of the data"] {
        assert!(outcome.stdout.contains(piece), "{piece}: {}", outcome.stdout);
    }
    assert!(outcome.stderr.contains("interplay run found.toml"), "{}", outcome.stderr);

    let building = &written(&folder.join("found.toml"))["building"];
    let number = |table: &toml::Value, key: &str| table[key].as_float().expect("a number");
    let (zone, wall) = (&building["zone"][0], &building["wall"][0]);
    let capacity = number(zone, "capacity_kj_per_k") + number(wall, "capacity_kj_per_k");
    assert!((capacity / CAPACITY - 1.0).abs() < 0.1, "{capacity}");
    assert!((number(wall, "resistance_k_per_kw") * CONDUCTANCE - 1.0).abs() < 0.05, "{wall}");
    let believed = &building["believed"];
    for key in ["capacity_factor", "outer_resistance_factor"] {
        assert!((1.0..1.25).contains(&number(believed, key)) && number(believed, key) > 1.0, "{believed}");
    }
    assert_eq!(number(believed, "inner_resistance_factor"), 1.0, "there is one zone");

    for controller in ["pid", "iterative-learning", "concurrent", "distributed", "centralised"] {
        let kind = format!("controller={{ kind = \"{controller}\" }}");
        let run = ["run", "found.toml", "--no-record", "--set", &kind, "--set", "iterations=2"];
        let outcome = interplay(&folder, &run);
        assert_eq!(outcome.code, Some(0), "{controller}: {outcome:?}");
    }
}

#[test]
fn identify_overwrites_no_file_and_omits_unknown_values() {
    let folder = house("identify-no-scenario");
    let outcome = interplay(&folder, &["identify", "house.csv", "--scenario", "house.toml"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("exists already"), "{}", outcome.stderr);
    assert_eq!(fs::read_to_string(folder.join("house.toml")).expect("kept"), MAPPING);

    fs::write(folder.join("house.toml"), MAPPING.replace("'kw'", "'unknown'")).expect("written");
    let outcome = interplay(&folder, &["identify", "house.csv", "--scenario", "found.toml"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stdout.contains("the record does not tell"), "what was found says why: {}", outcome.stdout);
    assert!(outcome.stderr.contains("no scale") && !folder.join("found.toml").exists(), "{}", outcome.stderr);
}

/// The sun is a key of the wall in the file, and a run with the file knows it.
#[test]
fn sun_on_a_wall_is_identified_as_sun_on_a_wall() {
    let folder = sunny_house("identify-sun");
    let outcome = interplay(&folder, &["identify", "house.csv", "--details", "--scenario", "found.toml"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stdout.contains("sun on the wall to outdoor"), "{}", outcome.stdout);
    let wall = &written(&folder.join("found.toml"))["building"]["wall"][0];
    let aperture_m2 = wall["solar_aperture_m2"].as_float().expect("a number");
    assert!((aperture_m2 / 1.5 - 1.0).abs() < 0.2, "{aperture_m2}");
    let run =
        ["run", "found.toml", "--no-record", "--set", "iterations=2", "--set", "controller={ kind = \"centralised\" }"];
    let outcome = interplay(&folder, &run);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
}

/// Standard deviation of the sensor in the cabin \[K\].
const SENSOR_NOISE_K: f64 = 0.03;
/// Seed and stream of its errors.
const SENSOR_SEED: [u64; 2] = [4, 1];
/// The day in January on which the table begins.
const FIRST_DAY: usize = 5;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/telemetry")
}

/// Fourteen days of the cabin as a table.
fn table() -> String {
    let path = folder().join("cabin-scenario.toml").display().to_string();
    let film = film(&path, load(&path, &[]).expect("a sound scenario"));
    let mut sensor = Random::new(SENSOR_SEED[0], SENSOR_SEED[1]);
    let mut text = String::from("time,cabin_c,outdoor_c,heating_kw,appliances_kw\n");
    for BuildingFrame { day, step, zones, ambient_c, .. } in
        film.frames.iter().filter_map(|frame| frame.building.as_ref())
    {
        let (hour, minute) = (step / 4, step % 4 * 15);
        let inside_c = zones[0].temperature_c + sensor.normal(0.0, SENSOR_NOISE_K);
        let [heating_kw, appliances_kw] = [zones[0].heat_kw, zones[0].gains_kw];
        writeln!(
            text,
            "2026-01-{:02} {hour:02}:{minute:02}:00,{inside_c:.2},{ambient_c:.2},{heating_kw:.2},{appliances_kw:.3}",
            FIRST_DAY + day
        )
        .expect("a text grows");
    }
    text
}

/// `INTERPLAY_BLESS=1` writes it anew.
#[test]
fn the_sample_table_matches_the_run_of_its_scenario() {
    let (path, simulated) = (folder().join("cabin.csv"), table());
    if std::env::var_os("INTERPLAY_BLESS").is_some() {
        fs::write(&path, &simulated).expect("the table can be written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == simulated, "{} is not what its scenario gives: renew it with INTERPLAY_BLESS=1", path.display());
    assert_eq!(written.lines().count(), 1 + 14 * 96);
    assert!(written.len() < 200_000, "{} bytes", written.len());
}

#[test]
fn the_parameters_of_the_cabin_are_identified_from_its_telemetry() {
    let table = folder().join("cabin.csv").display().to_string();
    let outcome = interplay(&scratch("sample-cabin"), &["identify", &table, "--json"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let report = outcome.json();
    // All capacities together, and the inverse of the wall's resistance.
    for (name, truth) in [("heat capacity", 18_000.0), ("conductance to outdoor", 1.0 / 6.0)] {
        let found = physical(&report, name);
        let [value, low, high] = [&found["value"], &found["interval"][0], &found["interval"][1]]
            .map(|number| number.as_f64().unwrap_or_else(|| panic!("not determined: {found}")));
        assert!((value / truth - 1.0).abs() < 0.02, "{found}");
        assert!((low..=high).contains(&truth), "{found}");
        assert_eq!(found["verdict"]["confidence"], "identified", "{found}");
    }
}

/// What the book warns of: without the column of the appliances the walls seem better than they are.
#[test]
fn unmapped_heat_makes_walls_appear_better_insulated() {
    let scratch = scratch("sample-telemetry");
    let mapping = fs::read_to_string(folder().join("cabin.toml")).expect("the mapping");
    let less: Vec<&str> = mapping.lines().filter(|line| !line.contains("appliances_kw")).collect();
    fs::write(scratch.join("less.toml"), less.join("\n")).expect("a scratch file");
    let table = folder().join("cabin.csv").display().to_string();
    let report = interplay(&scratch, &["identify", &table, "--mapping", "less.toml", "--json"]).json();
    let resistance = physical(&report, "resistance to outdoor");
    let [low_bound, high_bound] = [0, 1].map(|end| resistance["interval"][end].as_f64().expect("a bound"));
    assert!(low_bound > 6.4 && high_bound < 6.65, "{resistance}");
}

fn physical<'a>(report: &'a Value, name: &str) -> &'a Value {
    let all = report["zones"][0]["physical"].as_array().expect("a list");
    all.iter().find(|quantity| quantity["name"] == name).unwrap_or_else(|| panic!("no {name}"))
}
