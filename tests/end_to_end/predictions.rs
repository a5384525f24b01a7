//! Predictions of recorded cars, and drivers that are fitted to them.

#![allow(clippy::print_stderr, reason = "a test that skips says so")]

use std::fmt::Write;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::command::{interplay, scratch};

/// A queue of cars on a straight road behind one that changes its speed, each with a time gap of its own, as a table.
fn queue(cars: usize) -> String {
    let mut text = "id,time_s,x_m,y_m,heading_rad,speed_mps\n".to_owned();
    let mut states: Vec<[f64; 2]> = (0..cars).map(|car| [-30.0 * car as f64, 15.0]).collect();
    for step in 0..200 {
        let time_s = 0.2 * f64::from(step);
        for (car, [along_m, speed_mps]) in states.iter().enumerate() {
            // Writing to a text cannot fail.
            let _ = writeln!(text, "car-{car},{time_s:.1},{along_m:.4},0,0,{speed_mps:.4}");
        }
        for car in 0..cars {
            let [along_m, speed_mps] = states[car];
            let acceleration_mps2 = match car {
                0 => 1.2 * (0.35 * time_s).sin(),
                _ => {
                    let [ahead_m, ahead_mps] = states[car - 1];
                    let gap_m = ahead_m - along_m - 4.5;
                    let wanted_m = 3.5 + (0.8 + 0.1 * (car % 7) as f64) * speed_mps;
                    (0.15 * (gap_m - wanted_m) + 0.6 * (ahead_mps - speed_mps)).clamp(-4.0, 2.0)
                }
            };
            let next_mps = (speed_mps + 0.2 * acceleration_mps2).max(0.0);
            states[car] = [along_m + 0.1 * (speed_mps + next_mps), next_mps];
        }
    }
    text
}

fn folder_with_queue(name: &str, cars: usize) -> std::path::PathBuf {
    let folder = scratch(name);
    fs::write(folder.join("queue.csv"), queue(cars)).expect("it can be written");
    folder
}

#[test]
fn models_are_compared_on_cars_that_they_were_not_fitted_on() {
    let folder = folder_with_queue("predict-queue", 12);
    let said = interplay(&folder, &["predict", "queue.csv", "--starts", "60", "--json"]);
    assert_eq!(said.code, Some(0), "{said:?}");
    let document = said.json();
    let models = document["groups"][0]["models"].as_array().expect("models");
    let along_m = |name: &str| {
        let model = models.iter().find(|it| it["name"] == name).unwrap_or_else(|| panic!("{name}"));
        model["horizons"][2]["along_rmse_m"]["value"].as_f64().expect("a number")
    };
    assert!(along_m("human, fitted") < along_m("constant velocity"), "{document}");
    assert!(along_m("IDM, fitted") < along_m("IDM, literature"), "{document}");
    let again = interplay(&folder, &["predict", "queue.csv", "--starts", "60", "--json"]);
    assert_eq!(said.stdout, again.stdout, "the same again");
    let text = interplay(&folder, &["predict", "queue.csv", "--starts", "20"]);
    assert!(text.stdout.contains("human, fitted") && text.stdout.contains("How the recorded cars drive"), "{text:?}");
}

#[test]
fn each_group_is_judged_by_models_that_were_fitted_on_the_others() {
    let folder = folder_with_queue("predict-sites", 6);
    fs::write(folder.join("longer.csv"), queue(9)).expect("it can be written");
    let words = ["predict", "queue.csv", "longer.csv", "--leave-one-out", "--starts", "15", "--json"];
    let said = interplay(&folder, &words);
    assert_eq!(said.code, Some(0), "{said:?}");
    let document = said.json();
    let groups: Vec<&str> =
        document["groups"].as_array().expect("groups").iter().filter_map(|it| it["name"].as_str()).collect();
    assert_eq!(groups, ["queue", "longer", "all"]);
    assert_eq!((&document["groups"][0]["starts"], &document["groups"][2]["starts"]), (&15.into(), &30.into()));
    let names = document["groups"][0]["models"].as_array().expect("models");
    for name in ["human, measured", "seen motion", "IDM, literature with a fitted lag", "human, fitted"] {
        assert!(names.iter().any(|it| it["name"] == name), "{name}");
    }
    assert_eq!(said.stdout, interplay(&folder, &words).stdout, "the same again");
    let alone = interplay(&folder, &["predict", "queue.csv", "--leave-one-out"]);
    assert_eq!(alone.code, Some(2), "{alone:?}");
}

#[test]
fn the_driving_of_a_group_is_compared_with_that_of_the_first() {
    let folder = folder_with_queue("predict-driving", 6);
    fs::write(folder.join("longer.csv"), queue(9)).expect("it can be written");
    let said = interplay(&folder, &["predict", "queue.csv", "longer.csv", "--driving", "--json"]);
    assert_eq!(said.code, Some(0), "{said:?}");
    assert_eq!(said.json()["driving"].as_array().map(Vec::len), Some(2));
    let text = interplay(&folder, &["predict", "queue.csv", "longer.csv", "--driving"]);
    assert!(text.stdout.contains("How far from queue"), "{text:?}");
}

#[test]
fn a_driver_is_fitted_to_a_vehicle_of_a_table() {
    let folder = folder_with_queue("fit-queue", 3);
    let said = interplay(&folder, &["fit", "queue.csv", "--vehicle", "car-2", "--json"]);
    assert_eq!(said.code, Some(0), "{said:?}");
    let Value::Array(drivers) = said.json() else { panic!("{said:?}") };
    let gap_s = drivers[0]["time_gap_s"]["value"].as_f64().expect("a number");
    // It keeps 3.5 m and 1.0 s.
    assert!((0.5..1.8).contains(&gap_s), "{gap_s}: {said:?}");
    let text = interplay(&folder, &["fit", "queue.csv", "--vehicle", "car-2"]);
    assert!(text.stdout.contains("time gap beyond 3.5 m"), "{text:?}");
}

#[test]
fn files_that_are_not_recordings_are_refused_with_the_line() {
    let folder = folder_with_queue("predict-bad", 2);
    fs::create_dir(folder.join("empty")).expect("a folder");
    fs::write(folder.join("bad.xml"), "<commonRoad commonRoadVersion=\"2020a\" timeStepSize=\"no\"></commonRoad>")
        .expect("a file");
    fs::write(folder.join("bad.csv"), "id,time_s,x_m,y_m,heading_rad,speed_mps\na,0,0,0,0,fast\n").expect("a file");
    fs::write(folder.join("notes.txt"), "nothing").expect("a file");
    for (arguments, words) in [
        (&["predict", "bad.xml"][..], "bad.xml"),
        (&["predict", "bad.csv"], "bad.csv:2"),
        (&["predict", "missing.xml"], "missing.xml"),
        (&["predict", "missing.csv"], "missing.csv"),
        (&["predict", "empty"], "empty"),
        (&["predict", "notes.txt"], "notes.txt"),
        (&["predict", "queue.csv", "--starts", "0"], "whole number"),
        (&["fit", "queue.csv", "--vehicle", "stranger"], "stranger"),
        (&["fit", "queue.csv", "--vehicle", "car-0"], "car-0"),
        (&["fit", "bad.csv"], "bad.csv:2"),
    ] {
        let said = interplay(&folder, arguments);
        assert_eq!(said.code, Some(2), "{arguments:?}: {said:?}");
        assert!(said.stderr.contains(words) && said.stdout.is_empty(), "{arguments:?}: {said:?}");
    }
}

/// Real cars, which are no part of this repository: skipped, saying so, where they are absent.
#[test]
fn real_cars_are_predicted_better_than_by_constant_velocity() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/commonroad/USA_US101-4_1_T-1.xml");
    let Ok(file) = file.canonicalize() else {
        eprintln!("skipped: ../shared/data is not here");
        return;
    };
    let folder = scratch("predict-real");
    let said = interplay(&folder, &["predict", &file.to_string_lossy(), "--json"]);
    assert_eq!(said.code, Some(0), "{said:?}");
    let models = said.json()["groups"][0]["models"].clone();
    let idm = models.as_array().expect("models").iter().find(|it| it["name"] == "IDM, fitted").cloned().expect("it");
    assert!(idm["along_ratio_to_constant_velocity"]["value"].as_f64().expect("a number") < 1.2, "{idm}");
}
