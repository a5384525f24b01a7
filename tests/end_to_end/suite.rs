//! Many scenarios in one go: the same runs as one by one, judged together.

use std::fs;
use std::path::Path;

use interplay_scenarios::{embedded, load};
use serde_json::Value;

use crate::command::{contents, interplay, scratch};
use crate::film::FILMS;

/// A scenario of half a second.
fn short(folder: &Path, name: &str, expect: &str) {
    let text = format!(
        "extends = 'lane-change/front-nice'\ntitle = '{name}'\nduration_s = 0.5\n\
         [expect]\ncompletes = []\norder = ['ego', 'front', 'rear']\n{expect}\n"
    );
    let path = folder.join(name);
    fs::create_dir_all(path.parent().expect("below the folder")).expect("a folder can be made");
    fs::write(path, text).expect("a file can be written");
}

fn names(reports: &Value) -> Vec<&str> {
    let reports = reports.as_array().expect("an array");
    reports.iter().map(|report| report["scenario"].as_str().expect("a name")).collect()
}

#[test]
fn a_suite_without_arguments_runs_every_embedded_scenario_unchanged() {
    let folder = scratch("suite-all");
    let outcome = interplay(&folder, &["suite", "--json"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""), "{outcome:?}");
    let reports = outcome.json();
    assert_eq!(names(&reports), embedded().iter().map(|file| file.name).collect::<Vec<_>>());
    for report in reports.as_array().expect("an array") {
        let name = report["scenario"].as_str().expect("a name");
        let alone = match FILMS.iter().find(|film| film.name() == name) {
            Some(film) => film.report.digest.clone().into(),
            None => interplay(&folder, &["run", name, "--no-record", "--json"]).json()["digest"].clone(),
        };
        assert_eq!((&report["digest"], &report["passed"]), (&alone, &Value::Bool(true)), "{name}");
        let claimed = load(name, &[]).expect("authored").counterfactuals.len();
        let judged = report["counterfactuals"].as_array().expect("an array");
        assert!(judged.len() == claimed && judged.iter().all(|one| one["passed"] == true), "{name}: {judged:?}");
    }
    assert_eq!(contents(&folder), Vec::<String>::new(), "a suite records nothing");
}

#[test]
fn the_number_of_jobs_does_not_change_the_results_of_a_suite() {
    let folder = scratch("suite-jobs");
    for name in ["c.toml", "a.toml", "b.toml"] {
        short(&folder, name, "");
    }
    let digests = |jobs: &str| -> Vec<Value> {
        let reports = interplay(&folder, &["suite", ".", "--json", "--jobs", jobs]).json();
        assert_eq!(names(&reports), ["a", "b", "c"]);
        reports.as_array().expect("an array").iter().map(|report| report["phase_digests"].clone()).collect()
    };
    assert_eq!(digests("1"), digests("3"));
}

#[test]
fn a_failed_expectation_fails_the_suite_and_is_named() {
    let folder = scratch("suite-failed");
    short(&folder, "sub/good.toml", "");
    short(&folder, "sub/bad.toml", "min_gap_m = 9");
    let outcome = interplay(&folder, &["suite", "sub/good.toml", "sub", "--junit", "out.xml"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(1), ""), "{outcome:?}");
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    let starts = [
        "scenario ",
        "good ",
        "bad ",
        "  FAIL min_gap_m: wanted: at least 9.0 m; got: 0.",
        "good ",
        "FAILED: 2 of 3 met ",
    ];
    assert_eq!(lines.len(), starts.len(), "{}", outcome.stdout);
    for (line, start) in lines.iter().zip(starts) {
        assert!(line.starts_with(start), "`{line}` does not start with `{start}`");
    }
    assert!(lines[1].contains(" passed ") && lines[2].contains(" FAILED "), "{}", outcome.stdout);
    let xml = fs::read_to_string(folder.join("out.xml")).expect("the results were written");
    assert_eq!(xml.matches("<testcase ").count(), 3, "{xml}");
    assert_eq!(xml.matches("<failure message=\"min_gap_m: wanted: at least 9.0 m; got: 0.").count(), 1, "{xml}");
    assert!(xml.contains("tests=\"3\" skipped=\"0\" failures=\"1\" errors=\"0\""), "{xml}");
}

/// One unusable file does not keep the others from running; it is an error in the results, and the command ends with 2.
#[test]
fn a_suite_reports_all_invalid_files_and_runs_the_others() {
    let folder = scratch("suite-bad");
    short(&folder, "good.toml", "");
    fs::write(folder.join("one.toml"), "title = 3\n").expect("a file can be written");
    fs::write(folder.join("two.toml"), "[nonsense]\n").expect("a file can be written");
    fs::create_dir(folder.join("empty")).expect("a folder can be made");
    fs::create_dir_all(folder.join("sweeps/quick")).expect("a folder can be made");
    for (name, text) in [
        ("plan.toml", "scenario = ['good.toml']\nplanner = ['idm']\n"),
        ("sweeps/quick/plan.toml", "scenario = ['good.toml']\n"),
        ("base.toml", "title = 'A street'\n[road]\nkind = 'two-way'\n"),
        (
            "two-way.toml",
            "extends = 'base.toml'\nshows = 'A car'\nduration_s = 0.5\n[[vehicle]]\nname = 'ego'\nclass = 'car'\n\
         start = { lane = 'east', along_m = 5.0, speed_mps = 5.0 }\n",
        ),
    ] {
        fs::write(folder.join(name), text).expect("a file can be written");
    }
    let outcome = interplay(&folder, &["suite", ".", "missing.toml", "empty", "--json", "--junit", "out.xml"]);
    assert_eq!((outcome.code, names(&outcome.json())), (Some(2), vec!["good", "two-way"]), "{outcome:?}");
    for piece in [
        "one.toml",
        "two.toml",
        "missing.toml",
        "folder `empty` contains no scenario",
        "left out",
        "base.toml",
        "plan.toml",
    ] {
        assert!(outcome.stderr.contains(piece), "{piece}: {}", outcome.stderr);
    }
    assert!(!outcome.stderr.contains("sweeps"), "{}", outcome.stderr);
    let xml = fs::read_to_string(folder.join("out.xml")).expect("the results were written");
    assert!(xml.contains("failures=\"0\" errors=\"3\""), "{xml}");
    let checked = interplay(&folder, &["check", "."]);
    assert_eq!((checked.code, checked.stdout.matches("ok  ").count()), (Some(2), 2), "{checked:?}");
    assert_eq!(interplay(&folder, &["suite", "--jobs", "0"]).code, Some(2));
}

#[test]
fn unwritable_suite_results_exit_with_code_3() {
    let folder = scratch("suite-unwritable");
    short(&folder, "good.toml", "");
    let outcome = interplay(&folder, &["suite", "good.toml", "--junit", "good.toml/results.xml"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("good.toml/results.xml"), "{outcome:?}");
    assert!(outcome.stdout.contains("PASSED: 1 of 1 "), "{outcome:?}");
}

/// A street on which a car runs into one that stands, and nothing is expected.
const CONTACT: &str = "title = 'A contact'
shows = 'A car that does not brake'
duration_s = 6.0
[defaults]
class = 'car'
[road]
kind = 'lanes'
[[vehicle]]
name = 'ego'
start = { lane = 0, along_m = 0.0, speed_mps = 10.0 }
driver = { kind = 'scripted', script = [{ speed_mps = 10.0 }] }
[[vehicle]]
name = 'standing'
start = { lane = 0, along_m = 30.0, speed_mps = 0.0 }
goal = { speed_mps = 0.0 }
driver = { kind = 'scripted' }
";

#[test]
fn a_contact_that_the_ego_begins_fails_a_run_without_expectations() {
    let folder = scratch("contact");
    fs::write(folder.join("contact.toml"), CONTACT).expect("a file can be written");
    for command in [&["run", "contact.toml", "--no-record"][..], &["suite", "contact.toml"]] {
        let outcome = interplay(&folder, command);
        let said =
            "FAIL no_contact_by_ego: wanted: no contact that the ego begins, where nothing else is expected; got: ego ";
        assert!(outcome.code == Some(1) && outcome.stdout.contains(said), "{outcome:?}");
        let allowed = interplay(&folder, &[command, &["--allow-contacts"]].concat());
        assert_eq!(allowed.code, Some(0), "{allowed:?}");
    }
    fs::write(folder.join("contact.toml"), CONTACT.to_owned() + "[expect]\nno_collision = false\n").expect("written");
    assert_eq!(interplay(&folder, &["run", "contact.toml", "--no-record"]).code, Some(0), "a contact was expected");
}

#[test]
fn a_suite_takes_families_patterns_and_changes() {
    let folder = scratch("suite-changes");
    short(&folder, "mine.toml", "");
    let run = |arguments: &[&str]| interplay(&folder, &[&["suite", "--json"], arguments].concat());
    let changed = run(&["mine.toml", "--planner", "idm", "--seed", "7", "--set", "duration_s=0.3"]).json();
    assert_eq!((&changed[0]["seed"], &changed[0]["simulated_s"]), (&7.into(), &0.3.into()));
    assert_eq!(changed[0]["vehicles"][0]["driver"], "idm");
    let family =
        run(&["intersection/n*", "--set", "duration_s=0.3", "--set", "expect={}", "--set", "counterfactual=[]"]);
    assert!(names(&family.json()).iter().all(|name| name.starts_with("intersection/n")), "{family:?}");
    for planner in ["walker", "recorded", "inputs", "external"] {
        let refused = run(&["mine.toml", "--planner", planner]);
        assert!(refused.code == Some(2) && refused.stderr.contains("cannot drive `ego`"), "{refused:?}");
    }
}
