//! The same scenario and seed give the same run, bit for bit.
//!
//! The files in `golden/` hold digests of every tick, phase by phase, so that a difference names the moment and the phase
//! that made it. There is one set of them: a debug build (`cargo test -p interplay-tests determinism`) and a release build
//! (the same with `--release`) are both held to it, and so is every machine.
//!
//! A change that is meant to alter runs renews them: `INTERPLAY_BLESS=1 cargo test --release -p interplay-tests golden`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, thread};

use interplay::frame::Frame;
use interplay_planners::{Input, State, Trajectory};
use interplay_scenarios::embedded;
use serde_json::{Value, json};
use xxhash_rust::xxh3::Xxh3;

use crate::command::{interplay, scratch};
use crate::film::{FILMS, Film, authored, film};

/// What is digested of a tick, in the order in which it comes about. A state that differs was made by the physics of the
/// tick before.
const PHASES: [&str; 4] = ["physics (of the tick before)", "predict", "plan", "act"];

/// How a difference is dealt with.
const ADVICE: &str = "if the change is meant: INTERPLAY_BLESS=1 cargo test --release -p interplay-tests golden";

#[test]
fn golden_digests() {
    let films = FILMS.iter().filter(|film| embedded().iter().any(|file| file.name == film.name()));
    let mut differences = String::new();
    for film in films {
        let (path, found) = (golden_path(film.name()), golden(film));
        if env::var_os("INTERPLAY_BLESS").is_some_and(|value| value == "1") {
            fs::create_dir_all(path.parent().expect("a file is in a folder")).expect("golden folders can be made");
            fs::write(&path, format!("{found:#}\n")).expect("golden files can be written");
            continue;
        }
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}; {ADVICE}", path.display()));
        let wanted: Value = serde_json::from_str(&text).expect("a golden file is JSON");
        if wanted != found {
            writeln!(differences, "{}: {}", film.name(), difference(&wanted, &found)).expect("a text can grow");
        }
    }
    assert!(differences.is_empty(), "runs differ from tests/golden:\n{differences}{ADVICE}");
}

#[test]
fn a_difference_names_the_tick_and_the_phase() {
    let golden = |ticks: &[&str]| json!({ "ticks": ticks });
    let wanted = golden(&["1 2 3 4", "5 6 7 8"]);
    assert_eq!(difference(&wanted, &golden(&["1 2 3 4", "5 6 0 0"])), "first differs at tick 1, in plan");
    assert_eq!(
        difference(&wanted, &golden(&["1 2 3 4", "0 6 0 0"])),
        "first differs at tick 1, in physics (of the tick before)"
    );
    assert_eq!(difference(&wanted, &golden(&["1 2 3 4"])), "2 ticks became 1");
}

#[test]
fn another_process_gives_the_same_run() {
    let folder = scratch("another-process");
    for film in FILMS.iter().filter(|film| embedded().iter().any(|file| file.name == film.name())) {
        let report = interplay(&folder, &["run", film.name(), "--no-record", "--json"]).json();
        assert_eq!(report["digest"], film.report.digest, "{}", film.name());
    }
}

#[test]
fn recording_does_not_change_the_run() {
    let folder = scratch("recording-does-not-change");
    let changes = ["run", "--set", "duration_s=2", "--json", "lane-change/front-nice"];
    let alone = interplay(&folder, &[&changes[..], &["--no-record"]].concat()).json();
    let recorded = interplay(&folder, &changes).json();
    assert_eq!(alone["phase_digests"], recorded["phase_digests"]);
}

#[test]
fn worlds_side_by_side_do_not_disturb_one_another() {
    let scenario = || authored("lane-change/front-nice", &["duration_s=2"]);
    let alone = film("alone", scenario());
    thread::scope(|scope| {
        let running: Vec<_> = (0..4).map(|_| scope.spawn(|| film("side by side", scenario()))).collect();
        for other in running {
            let other = other.join().expect("no run panics");
            assert_eq!(other.report.phase_digests, alone.report.phase_digests);
        }
    });
}

#[test]
fn the_seed_decides_the_random_starts() {
    let digest = |seed: u64| {
        let seed = format!("seed={seed}");
        let changes = ["start_jitter.position_m=0.05", "duration_s=1.5", &seed];
        film("seeded", authored("lane-change/front-nice", &changes)).report.digest
    };
    assert_eq!(digest(3), digest(3));
    assert_ne!(digest(3), digest(4));
}

fn golden_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden").join(format!("{name}.json"))
}

/// What the golden file of a run holds.
fn golden(film: &Film) -> Value {
    let ticks: Vec<String> = film.frames.iter().map(row).collect();
    json!({ "digest": film.report.digest, "ticks": ticks })
}

/// The digests of one tick, one for each of [`PHASES`].
fn row(frame: &Frame) -> String {
    let mut digests = [const { Xxh3::new() }; 4];
    let [physics, predict, plan, act] = &mut digests;
    for vehicle in &frame.vehicles {
        states(physics, &[vehicle.state]);
        trajectory(predict, &vehicle.prediction);
        trajectory(plan, &vehicle.plan.trajectory);
        inputs(act, &[vehicle.input]);
    }
    digests.map(|digest| format!("{:016x}", digest.digest())).join(" ")
}

fn trajectory(digest: &mut Xxh3, trajectory: &Trajectory) {
    states(digest, &trajectory.states);
    inputs(digest, &trajectory.inputs);
}

fn states(digest: &mut Xxh3, states: &[State]) {
    states.iter().flat_map(|state| state.to_array()).for_each(|value| digest.update(&value.to_bits().to_le_bytes()));
}

fn inputs(digest: &mut Xxh3, inputs: &[Input]) {
    inputs.iter().flat_map(|input| input.to_array()).for_each(|value| digest.update(&value.to_bits().to_le_bytes()));
}

/// Where two golden files differ first.
fn difference(wanted: &Value, found: &Value) -> String {
    let ticks = |golden: &Value| -> Vec<String> {
        let rows = golden["ticks"].as_array().into_iter().flatten();
        rows.map(|row| row.as_str().unwrap_or_default().to_owned()).collect()
    };
    let (wanted, found) = (ticks(wanted), ticks(found));
    for (tick, (a, b)) in wanted.iter().zip(&found).enumerate() {
        if let Some(phase) = a.split(' ').zip(b.split(' ')).position(|(a, b)| a != b) {
            return format!("first differs at tick {tick}, in {}", PHASES[phase]);
        }
    }
    match wanted.len() == found.len() {
        true => "only the states after the last tick differ, in physics".to_owned(),
        false => format!("{} ticks became {}", wanted.len(), found.len()),
    }
}
