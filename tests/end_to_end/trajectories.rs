//! Tables of what every vehicle did at every tick: of a run and of a sweep.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::command::{Outcome, contents, interplay, scratch};

/// A run that is over soon.
const SHORT: [&str; 5] = ["run", "lane-change/front-nice", "--set", "duration_s=2.0", "--no-record"];

fn run(folder: &Path, more: &[&str]) -> Outcome {
    interplay(folder, &[&SHORT[..], more].concat())
}

/// The columns of a CSV without quotes, by their names.
pub(crate) fn columns(path: &Path) -> BTreeMap<String, Vec<String>> {
    let text = fs::read_to_string(path).expect("written");
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let names = lines.next().expect("a header");
    let rows: Vec<Vec<String>> = lines.collect();
    let column = |at: usize| rows.iter().map(|row| row[at].clone()).collect();
    names.into_iter().enumerate().map(|(at, name)| (name, column(at))).collect()
}

#[test]
fn every_vehicle_has_a_correct_row_at_every_tick() {
    let folder = scratch("trajectories-csv");
    let outcome = run(&folder, &["--trajectories", "new/run.csv"]);
    assert!(outcome.stderr.contains("trajectories in new/run.csv"), "{}", outcome.stderr);
    let table = columns(&folder.join("new/run.csv"));
    let number = |name: &str, row: usize| table[name][row].parse::<f64>().expect("a number");
    let vehicles = 3;
    let rows = table["tick"].len();
    assert_eq!((rows % vehicles, table["vehicle"][0].as_str()), (0, "ego"));
    for row in vehicles..rows {
        let before = row - vehicles;
        assert_eq!(table["vehicle"][row], table["vehicle"][before]);
        let step_s = number("time_s", row) - number("time_s", before);
        let gained_mps = number("speed_mps", row) - number("speed_mps", before);
        assert!((gained_mps - step_s * number("acceleration_mps2", before)).abs() < 1e-9, "row {row}");
        let moved_m = (number("x_m", row) - number("x_m", before)).hypot(number("y_m", row) - number("y_m", before));
        assert!((moved_m - step_s * number("speed_mps", before)).abs() < 1e-9, "row {row}");
    }
    assert!(table["plan"].iter().all(|word| word == "planned"), "no planner fails here");
    let of_ego = |name: &str| (0..rows).step_by(vehicles).map(|row| table[name][row].clone()).collect::<Vec<_>>();
    assert!(of_ego("plan_cost").iter().all(|cost| cost.parse::<f64>().is_ok()), "the ego's planner states its cost");
    assert!(of_ego("partner").iter().any(|partner| partner == "front"), "{:?}", of_ego("partner"));
}

#[test]
fn writing_tables_changes_no_run_and_overwrites_no_file() {
    let folder = scratch("trajectories-unharmed");
    let digest = |more: &[&str]| run(&folder, more).json()["digest"].clone();
    let plain = digest(&["--json"]);
    for file in ["one.parquet", "two.parquet"] {
        assert_eq!(digest(&["--json", "--trajectories", file]), plain);
    }
    let bytes = |file: &str| fs::read(folder.join(file)).expect("written");
    assert!(bytes("one.parquet") == bytes("two.parquet") && bytes("one.parquet").starts_with(b"PAR1"));
    fs::create_dir(folder.join("a-folder.csv")).expect("new");
    let cases: [(&[&str], i32, &str); 5] = [
        (&["--trajectories", "run.txt"], 2, ".parquet"),
        (&["--trajectories", "one.gif.csv", "--animate", "one.gif", "--export", "one.gif.csv"], 2, ".xml"),
        (&["--export", "same.xml", "--trajectories", "a-folder.csv"], 3, "it is a folder"),
        (&["--export", "run.toml"], 2, ".xml"),
        (&["--export", "a-folder.csv/run.xml/below.xml"], 0, ""),
    ];
    for (more, code, said) in cases {
        let outcome = run(&folder, more);
        assert!(outcome.code == Some(code) || code == 0, "{more:?}: {:?} {}", outcome.code, outcome.stderr);
        assert!(outcome.stderr.contains(said), "{more:?}: {}", outcome.stderr);
    }
    let building = interplay(&folder, &["run", "building/two-room-pid", "--no-record", "--trajectories", "none.csv"]);
    assert_eq!(building.code, Some(2), "{}", building.stderr);
    assert!(!folder.join("none.csv").exists() && !folder.join("same.xml").exists());
}

#[test]
fn a_sweep_writes_a_table_of_each_run_named_by_its_key() {
    let folder = scratch("trajectories-sweep");
    let plan = "scenario = ['lane-change/front-nice']\nplanner = ['idm', 'conservative']\nset = { duration_s = 2.0, expect = {} }\n";
    fs::write(folder.join("plan.toml"), plan).expect("writes");
    let sweep = |more: &[&str]| interplay(&folder, &[&["sweep", "plan.toml", "--out", "out"][..], more].concat());
    assert_eq!(sweep(&["--keep", "trajectories", "--keep", "failures"]).code, Some(0));
    let journal = fs::read_to_string(folder.join("out/journal.jsonl")).expect("written");
    let key = |line: &str| serde_json::from_str::<serde_json::Value>(line).expect("a row")["key"].clone();
    let mut expected: Vec<String> =
        journal.lines().map(|line| format!("{}.parquet", key(line).as_str().expect("a text"))).collect();
    expected.sort();
    assert_eq!((contents(&folder.join("out/trajectories")), expected.len()), (expected, 2));
}
