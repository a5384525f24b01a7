//! Bad input: exit code 2 (3 for a recording that cannot be written), one clear message, no panic, nothing left behind.

use std::fs;
use std::path::Path;

use interplay_scenarios::embedded;

use crate::command::{Outcome, contents, interplay, scratch};

/// A scenario without fault, to be spoilt.
const SOUND: &str = r#"
title = "One car"
shows = "Nothing wrong"
duration_s = 0.5

[road]
kind = "lanes"
lane_width_m = 0.37

[[vehicle]]
name = "ego"
start = { x_m = 0.0, y_m = 0.185, speed_mps = 1.0 }

[[vehicle]]
name = "other"
start = { x_m = 2.0, y_m = 0.185, speed_mps = 1.0 }
"#;

/// Runs a file with that content, whose name is `my.toml`.
fn run_file(test: &str, content: impl AsRef<[u8]>) -> Outcome {
    let folder = scratch(test);
    fs::write(folder.join("my.toml"), content).expect("a scratch file can be written");
    let outcome = interplay(&folder, &["run", "my.toml"]);
    assert_eq!(contents(&folder), ["my.toml"], "something was left behind");
    outcome
}

/// Runs [`SOUND`] with one text replaced.
fn run_spoilt(test: &str, sound: &str, spoilt: &str) -> Outcome {
    assert!(SOUND.contains(sound), "{sound}");
    run_file(test, SOUND.replace(sound, spoilt))
}

/// Holds an outcome to the contract of bad input: refused with one message that contains all of `pieces`.
#[track_caller]
fn refused(outcome: &Outcome, pieces: &[&str]) {
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    one_message(outcome, pieces);
}

#[track_caller]
fn one_message(outcome: &Outcome, pieces: &[&str]) {
    let Outcome { stdout, stderr, .. } = outcome;
    assert_eq!(stdout, "", "results only on stdout");
    assert!(!stderr.contains("panicked"), "{stderr}");
    assert!((1..4000).contains(&stderr.len()), "{} bytes: {stderr}", stderr.len());
    for piece in pieces {
        assert!(stderr.contains(piece), "`{piece}` is not said in:\n{stderr}");
    }
}

#[test]
fn the_reference_file_of_the_bad_inputs_is_valid() {
    let folder = scratch("sound");
    fs::write(folder.join("my.toml"), SOUND).expect("a scratch file can be written");
    assert_eq!(interplay(&folder, &["run", "my.toml", "--no-record"]).code, Some(0));
    assert_eq!(contents(&folder), ["my.toml"]);
}

#[test]
fn an_unknown_key_is_refused_with_a_suggestion() {
    let outcome = run_spoilt("unknown-key", "lane_width_m", "lane_widht_m");
    refused(&outcome, &["1 error", "my.toml:8:1", "unknown key `lane_widht_m`", "did you mean `lane_width_m`"]);
}

#[test]
fn a_missing_file_is_refused() {
    let outcome = interplay(&scratch("missing"), &["run", "missing.toml"]);
    refused(&outcome, &["missing.toml", "interplay list"]);
}

#[test]
fn a_misspelt_scenario_is_refused_with_a_suggestion() {
    let outcome = interplay(&scratch("misspelt"), &["run", "front-nicer"]);
    refused(&outcome, &["front-nicer", "did you mean the embedded scenario `lane-change/front-nice`"]);
}

#[test]
fn a_text_in_place_of_a_number_is_refused() {
    let outcome = run_spoilt("nan", "speed_mps = 1.0", "speed_mps = nan");
    refused(&outcome, &["my.toml:12:47", "`vehicle.ego.start.speed_mps` must be a finite number"]);
}

#[test]
fn a_negative_width_is_refused() {
    let outcome = run_spoilt("negative-width", "0.37", "-0.37");
    refused(&outcome, &["my.toml:8:16", "`road.lane_width_m` must be at least 0.001, not -0.37"]);
}

#[test]
fn overlapping_cars_are_refused() {
    let outcome = run_spoilt("overlap", "x_m = 2.0", "x_m = 0.3");
    refused(&outcome, &["my.toml:16", "vehicles `ego` and `other` overlap at the start"]);
}

#[test]
fn a_directory_is_refused() {
    let folder = scratch("directory");
    fs::create_dir(folder.join("some.toml")).expect("a folder can be made");
    refused(&interplay(&folder, &["run", "some.toml"]), &["`some.toml` is a directory"]);
}

#[test]
fn an_empty_file_is_refused() {
    refused(&run_file("empty", ""), &["`my.toml` is empty", "`title`, `shows` and a `[[vehicle]]`"]);
}

#[test]
fn random_bytes_are_refused() {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let bytes: Vec<u8> = std::iter::repeat_with(|| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as u8
    })
    .take(10_000_000)
    .collect();
    refused(&run_file("random-10-mb", &bytes), &["`my.toml` is larger than 1 MiB"]);
    refused(&run_file("random-100-kb", &bytes[..100_000]), &["`my.toml` is not UTF-8 text"]);
}

#[test]
fn a_wrong_path_in_set_is_refused() {
    let folder = scratch("bad-set");
    let set = |change: &str| interplay(&folder, &["run", "--no-record", "--set", change]);
    refused(&set("vehicle.ego.gaol.lane=1"), &["--set", "unknown key `gaol`", "did you mean `goal`"]);
    refused(&set("vehicle.egg.goal.lane=1"), &["--set", "there is no `egg` in `vehicle`", "did you mean `ego`"]);
    refused(&set("vehicle.ego.goal.lane"), &["--set"]);
    refused(&set("vehicle.ego=5"), &["--set", "`vehicle.ego` must be a table, not a whole number"]);
    refused(&set("duration_s=nan"), &["--set", "`duration_s` must be a finite number"]);
}

#[test]
fn an_unknown_planner_is_refused() {
    let outcome = interplay(&scratch("bad-planner"), &["run", "--planner", "conservativ", "--no-record"]);
    refused(&outcome, &["--planner", "conservativ", "did you mean `conservative`"]);
    let folder = scratch("planner-without-vehicles");
    let outcome = interplay(&folder, &["run", "building/distributed", "--planner", "idm", "--no-record"]);
    refused(&outcome, &["--planner", "the scenario has no vehicles, so `--planner` has nothing to change"]);
}

#[test]
fn bad_arguments_are_refused() {
    let folder = scratch("bad-arguments");
    for (misspelt, meant) in [("runn", "'run'"), ("chekc", "'check'"), ("swep", "'sweep'"), ("compre", "'compare'")] {
        let said = format!("unrecognized subcommand '{misspelt}'");
        refused(&interplay(&folder, &[misspelt]), &[&said, "similar subcommand", meant]);
    }
    for seed in ["two", "-1", "1.5", "18446744073709551616"] {
        let pieces = [&format!("'{seed}'"), "--seed", "a seed is a whole number from 0 to 18446744073709551615"];
        refused(&interplay(&folder, &["run", "--seed", seed]), &pieces);
        refused(&interplay(&folder, &["run", &format!("--seed={seed}")]), &pieces);
    }
    refused(&interplay(&folder, &["run", "--no-record", "--record", "a.rrd"]), &["cannot be used with"]);
    refused(&interplay(&folder, &["check"]), &["FILE"]);
}

#[test]
fn check_continues_after_an_invalid_file() {
    let folder = scratch("check");
    fs::write(folder.join("a.toml"), SOUND.replace("speed_mps", "speed")).expect("a scratch file can be written");
    fs::write(folder.join("b.toml"), SOUND).expect("a scratch file can be written");
    fs::write(folder.join("c.toml"), "title = ").expect("a scratch file can be written");
    let outcome = interplay(&folder, &["check", ".", embedded()[0].name, "nowhere"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    let (approved, costs): (Vec<&str>, Vec<&str>) = outcome.stdout.lines().partition(|line| line.starts_with("ok  "));
    assert_eq!(approved, ["ok  ./b.toml", &format!("ok  {}", embedded()[0].name)]);
    assert!(costs.len() == 3 && costs.iter().all(|cost| cost.contains(" makes ")), "{costs:?}");
    for piece in ["a.toml:12", "c.toml:1", "nowhere"] {
        assert!(outcome.stderr.contains(piece), "{}", outcome.stderr);
    }
}

/// A recording that cannot be written is refused before anything is simulated. The tests may run as root, which ignores
/// permissions: so the path is below a file, or a folder.
#[test]
fn an_unwritable_recording_is_refused_before_the_run() {
    let folder = scratch("unwritable-recording");
    fs::write(folder.join("file"), "kept").expect("a scratch file can be written");
    fs::create_dir(folder.join("folder.rrd")).expect("a folder can be made");
    for target in ["file/my.rrd", "file/deeper/my.rrd", "folder.rrd"] {
        let outcome = interplay(&folder, &["run", "--record", target]);
        assert_eq!(outcome.code, Some(3), "{outcome:?}");
        one_message(&outcome, &[target, "--no-record"]);
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
        assert_eq!(contents(&folder), ["file", "folder.rrd"]);
        assert_eq!(fs::read_to_string(folder.join("file")).expect("still there"), "kept");
    }
    if Path::new("/dev/full").exists() {
        let outcome = interplay(&folder, &["run", "--record", "/dev/full"]);
        assert_eq!(outcome.code, Some(3), "{outcome:?}");
        one_message(&outcome, &["/dev/full"]);
    }
}
