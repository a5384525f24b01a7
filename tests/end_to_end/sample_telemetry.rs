//! The telemetry in the repository is simulated from its scenario, and identification recovers that scenario's cabin.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use interplay_common::random::Random;
use interplay_scenarios::load;
use interplay_simulation::frame::BuildingFrame;
use serde_json::Value;

use crate::command::{interplay, scratch};
use crate::film::film;

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
