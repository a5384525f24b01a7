//! The same scenario and seed give the same run, bit for bit.
//!
//! The files in `golden/` hold digests of every tick, phase by phase, so that a difference names the moment and the phase
//! that made it. There is one set of them: a debug build (`cargo test -p interplay-tests determinism`) and a release build
//! (the same with `--release`) are both held to it, and so is every machine.
//!
//! A change that is meant to alter runs renews them: `INTERPLAY_BLESS=1 cargo test --release -p interplay-tests golden`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{env, fs};

use interplay_scenarios::{embedded, from_text};
use interplay_simulation::measure::Digest;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::command::{interplay, scratch};
use crate::film::{FILMS, FILMS_OF_PEOPLE, Film, authored, film};

/// How a difference is dealt with.
const ADVICE: &str = "if the change is meant: INTERPLAY_BLESS=1 cargo test --release -p interplay-tests golden";

#[test]
fn golden_digests() {
    let films = FILMS
        .iter()
        .chain(FILMS_OF_PEOPLE.iter())
        .filter(|film| embedded().iter().any(|file| file.name == film.name()));
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

/// A scenario that is written to a file runs like the scenario, on parallel lanes, curves and networks, at both sizes, and in a
/// building.
#[test]
fn a_written_scenario_gives_the_same_run() {
    let driving = ["duration_s=2", "expect.completes=[]", "counterfactual=[]"];
    let cases = [
        ("lane-change/front-nice", driving),
        ("lane-keeping/inferred", driving),
        ("curve/lane-drop", driving),
        ("full-size/lane-change", driving),
        ("roundabout/nice", driving),
        ("building/epw-weather", ["iterations=2", "expect.zone=[]", "counterfactual=[]"]),
    ];
    cases.par_iter().for_each(|(name, changes)| {
        let scenario = authored(name, changes);
        let again = from_text("written.toml", &scenario.to_file().to_toml(), &[]).expect("what was written");
        let [one, other] = [scenario, again].map(|scenario| film(name, scenario));
        let (wanted, found) = (golden(&one), golden(&other));
        assert!(wanted == found, "{name}: {}", difference(&wanted, &found));
    });
}

#[test]
fn a_difference_between_runs_names_its_tick_and_phase() {
    let golden = |ticks: &[&str]| json!({ "phases": ["sense", "plan", "act"], "ticks": ticks });
    let wanted = golden(&["1 2 3", "4 5 6"]);
    assert_eq!(difference(&wanted, &golden(&["1 2 3", "4 0 0"])), "first differs at tick 1, in plan");
    assert_eq!(difference(&wanted, &golden(&["1 2 3", "0 0 6"])), "first differs at tick 1, in sense");
    assert_eq!(difference(&wanted, &golden(&["1 2 3"])), "2 ticks became 1");
    assert_eq!(difference(&wanted, &json!({ "phases": ["plan"], "ticks": [] })), "digests of other phases");
}

/// A human that changes its mind half-way is found out: in the tick in which it happens, in the phase Plan. The digests
/// of the whole runs could not tell: they all differ.
#[test]
fn a_changed_decision_is_located_by_tick_and_phase_plan() {
    let run = |changes: &[&str]| {
        let short = ["duration_s=1", "expect.completes=[]"];
        film("mind", authored("lane-change/front-nice", &[&short[..], changes].concat()))
    };
    let (one, mut other) = (run(&[]), run(&[]));
    assert_eq!(golden(&one), golden(&other));
    let front = &mut other.frames[4].vehicles[1];
    Arc::make_mut(&mut front.plan).trajectory.inputs[3].steering_rad += 1e-15;
    front.prediction = front.plan.trajectory.clone().into();
    assert_eq!(difference(&golden(&one), &golden(&other)), "first differs at tick 4, in plan");
    let faster = run(&["vehicle.front.goal.speed_mps=1.3"]);
    assert_eq!(difference(&golden(&one), &golden(&faster)), "first differs at tick 0, in plan");
    let pairs = one.report.phase_digests.by_name().into_iter().zip(faster.report.phase_digests.by_name());
    assert!(pairs.into_iter().all(|((_, a), (_, b))| a != b));
}

#[test]
fn a_run_in_another_process_is_identical() {
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
fn parallel_worlds_do_not_affect_each_other() {
    let scenario = || authored("lane-change/front-nice", &["duration_s=2"]);
    let alone = film("alone", scenario());
    (0..4).into_par_iter().for_each(|_| {
        let other = film("side by side", scenario());
        assert_eq!(other.report.phase_digests, alone.report.phase_digests);
    });
}

#[test]
fn random_starts_are_a_function_of_the_seed() {
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
    let names: Vec<&str> = Digest::default().phases().by_name().map(|(name, _)| name).to_vec();
    let ticks: Vec<String> = (0..film.frames.len()).map(|tick| row(film, tick)).collect();
    json!({ "digest": film.report.digest, "phases": names, "ticks": ticks })
}

/// The digests of one tick, one for each phase; half their length is plenty.
fn row(film: &Film, tick: usize) -> String {
    let digests = Digest::of_tick(&film.frames[tick], &film.states_after(tick));
    digests.by_name().map(|(_, digest)| &digest[..16]).join(" ")
}

/// Where two golden files differ first.
fn difference(wanted: &Value, found: &Value) -> String {
    let texts = |golden: &Value, key: &str| -> Vec<String> {
        let items = golden[key].as_array().into_iter().flatten();
        items.map(|item| item.as_str().unwrap_or_default().to_owned()).collect()
    };
    let phases = texts(found, "phases");
    if texts(wanted, "phases") != phases {
        return "digests of other phases".to_owned();
    }
    let (wanted, found) = (texts(wanted, "ticks"), texts(found, "ticks"));
    for (tick, (a, b)) in wanted.iter().zip(&found).enumerate() {
        if let Some(phase) = a.split(' ').zip(b.split(' ')).position(|(a, b)| a != b) {
            return format!("first differs at tick {tick}, in {}", phases[phase]);
        }
    }
    format!("{} ticks became {}", wanted.len(), found.len())
}
