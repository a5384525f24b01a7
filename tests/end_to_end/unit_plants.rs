//! A building that is an FMU on this machine, run in a process of its own. The FMU is one that `interplay export-fmu` makes.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::command::{Outcome, interplay, scratch};

/// A room for three days, with the weather of its seed.
const ROOM: &str = "title = 'A room'\nshows = 'B'\niterations = 3\n[building]\nstep_s = 1800.0\n[[building.zone]]\nname = 'room'\n\
    capacity_kj_per_k = 900.0\nheating_limit_kw = 8.0\ncooling_limit_kw = 0.0\n[[building.wall]]\nbetween = ['room', 'ambient']\n\
    resistance_k_per_kw = 6.0\ncapacity_kj_per_k = 9000.0\n[weather]\nkind = 'synthetic'\n[weather.climate]\nmean_c = 4.0\n\
    [setpoints]\noccupied_c = [21.0]\n[controller]\nkind = 'pid'\n";
const UNIT: &str = "extends = 'room.toml'\n[building.plant]\nkind = 'boptest'\nfmu = 'room.fmu'\nsampling_s = 1800.0\nwarmup_days = 0\n\
    timeout_s = 60.0\n[[building.plant.zones]]\ntemperature = 'room.temperature'\n\
    inputs = [{ name = 'room.heat', per_kw = 1.0, max = 100.0 }]\n";

/// A measurement that the unit does not have.
const NO_SUCH_NAME: &str = "building.plant.zones=[{ temperature = 'rom.temperature', \
    inputs = [{ name = 'room.heat', per_kw = 1.0, max = 100.0 }] }]";

fn run(folder: &Path, file: &str, more: &[&str]) -> Outcome {
    interplay(folder, &[&["run", file, "--no-record", "--json"], more].concat())
}

fn prepared(name: &str) -> std::path::PathBuf {
    let folder = scratch(name);
    fs::write(folder.join("room.toml"), ROOM).expect("written");
    fs::write(folder.join("unit.toml"), UNIT).expect("written");
    let exported = interplay(&folder, &["export-fmu", "room.toml", "--out", "room.fmu"]);
    assert_eq!(exported.code, Some(0), "{exported:?}");
    folder
}

#[test]
fn an_fmu_exported_by_interplay_behaves_like_its_building() {
    let folder = prepared("unit-as-plant");
    let [network, unit] = ["room.toml", "unit.toml"].map(|file| {
        let outcome = run(&folder, file, &[]);
        assert_eq!(outcome.code, Some(0), "{outcome:?}");
        serde_json::from_str::<Value>(&outcome.stdout).expect("JSON")
    });
    let days = |report: &Value| report["building"]["iterations"].as_array().expect("days").clone();
    assert_eq!((days(&network).len(), days(&unit).len()), (3, 3));
    for (day, (one, other)) in days(&network).iter().zip(&days(&unit)).enumerate() {
        for key in ["cost", "tracking_rmse_c", "energy_kwh", "peak_kw"] {
            let (one, other) = (one[key].as_f64().expect("a number"), other[key].as_f64().expect("a number"));
            assert!((one - other).abs() <= 1e-9 * one.abs().max(1.0), "day {day}, {key}: {one} and {other}");
        }
    }
}

#[test]
fn an_fmu_that_cannot_run_ends_the_run_with_a_reason() {
    let folder = prepared("unit-that-fails");
    let missing = run(&folder, "unit.toml", &["--set", "building.plant.fmu='rom.fmu'"]);
    assert_eq!(missing.code, Some(2), "{missing:?}");
    assert!(missing.stderr.contains("there is no file"), "{missing:?}");
    let both = run(&folder, "unit.toml", &["--set", "building.plant.url='http://127.0.0.1:1'"]);
    assert_eq!(both.code, Some(2), "{both:?}");
    let unknown = run(&folder, "unit.toml", &["--set", NO_SUCH_NAME]);
    assert_eq!(unknown.code, Some(3), "{unknown:?}");
    assert!(unknown.stderr.contains("room.temperature"), "{unknown:?}");
    // A unit refuses communication steps that are no whole steps of its own.
    let steps = run(&folder, "unit.toml", &["--set", "building.plant.sampling_s=900"]);
    assert_eq!(steps.code, Some(3), "{steps:?}");
    assert!(steps.stderr.contains("fmi2DoStep"), "{steps:?}");
    fs::write(folder.join("room.fmu"), "no archive").expect("written");
    let broken = run(&folder, "unit.toml", &[]);
    assert_eq!(broken.code, Some(3), "{broken:?}");
    assert!(broken.stderr.contains("is not an FMU"), "{broken:?}");
}
