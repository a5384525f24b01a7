//! What the command prints: results on stdout, the rest on stderr, and one JSON document with `--json`.

use std::fs;
use std::process::Stdio;

use interplay_scenarios::embedded;
use serde_json::Value;

use crate::command::{Outcome, command, interplay, scratch};

/// Holds an object to exactly these keys, in this order.
#[track_caller]
fn has_keys(object: &Value, keys: &str) {
    let found: Vec<&str> = object.as_object().expect("an object").keys().map(String::as_str).collect();
    let (mut found, mut wanted) = (found, keys.split_whitespace().collect::<Vec<_>>());
    found.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(found, wanted);
}

#[test]
fn the_report_of_a_run_has_the_documented_keys() {
    let arguments = ["run", "--set", "duration_s=2", "--no-record", "--json", "--seed", "5"];
    let outcome = interplay(&scratch("json-report"), &arguments);
    let report = outcome.json();
    assert_eq!(outcome.stderr, "");
    has_keys(
        &report,
        "scenario passed seed simulated_s wall_s digest phase_digests collisions contact_by_ego min_gap_m smallest_gap \
         shortest_time_to_collision right_of_way broken_rules deadlocks order vehicles expectations counterfactuals",
    );
    assert_eq!(report["scenario"], "lane-change/front-nice");
    assert_eq!(report["seed"], 5);
    assert_eq!(report["simulated_s"], 2.0);
    assert!(report["wall_s"].as_f64().is_some_and(|wall_s| wall_s > 0.0));
    assert!(report["digest"].as_str().is_some_and(|digest| digest.len() == 32));
    has_keys(&report["phase_digests"], "sense predict plan act physics");
    has_keys(&report["smallest_gap"], "m between time_s");
    has_keys(&report["shortest_time_to_collision"], "s between time_s");
    assert_eq!(report["right_of_way"], serde_json::json!([]), "on one road, no paths cross");
    for vehicle in report["vehicles"].as_array().expect("a list") {
        has_keys(
            vehicle,
            "name driver completed_s standing final min_speed_mps max_speed_mps mean_abs_acceleration mean_abs_jerk \
             peak_acceleration_mps2 peak_braking_mps2 peak_braking_share hard_braking peak_jerk_mps3 \
             peak_lateral_acceleration_mps2 peak_urgency peak_calm_jerk_mps3 peak_urgent_jerk_mps3 \
             peak_calm_lateral_acceleration_mps2 wanted_speed_share astride_s longest_astride_s oncoming_s longest_oncoming_s \
             oncoming_past_queue_s min_gap_at_rest_m max_gap_at_rest_m blocks_junction_s off_road_m leaves_road speeding_mps peak_steering_rate_radps short_gap_share median_time_gap_s \
             accepted_lead_gap_s accepted_lag_gap_s follower_braking_mps2 follower_brakes post_encroachment_s emergency_braking \
             rules_broken unexplained_standing_s deadlocks contacts_at_fault cut_ins peak_times_s plans",
        );
        has_keys(
            &vehicle["peak_times_s"],
            "acceleration braking braking_share calm_jerk calm_lateral_acceleration jerk lateral_acceleration off_road speeding \
             steering_rate urgency urgent_jerk",
        );
        assert_eq!(vehicle["speeding_mps"], Value::Null, "this road has no limits");
        has_keys(&vehicle["final"], "x_m y_m heading_rad speed_mps");
        has_keys(&vehicle["plans"], "count failed unfinished violating over_budget median_ms p99_ms");
        assert_eq!(vehicle["plans"]["count"], 20);
    }
    for expectation in report["expectations"].as_array().expect("a list") {
        has_keys(expectation, "what want got passed");
    }
}

/// Times are rounded: not 0.30000000000000004.
#[test]
fn times_in_reports_are_rounded() {
    let folder = scratch("times");
    let changes = ["run", "--no-record", "--set", "duration_s=0.3", "--set", "expect.completes=[]"];
    let outcome = interplay(&folder, &[&changes[..], &["--json"]].concat());
    assert!(outcome.stdout.contains("\"simulated_s\": 0.3,"), "{}", outcome.stdout);
    assert!(interplay(&folder, &changes).stdout.contains("\n  0.3 s simulated in "));
}

/// Two seconds are too short to change lane: the code says so, and the document is still whole.
#[test]
fn a_failed_expectation_exits_with_code_1() {
    let arguments = ["run", "--set", "duration_s=2", "--no-record", "--json"];
    let outcome = interplay(&scratch("failed"), &arguments);
    assert_eq!((outcome.code, &outcome.json()["passed"]), (Some(1), &Value::Bool(false)));
}

#[test]
fn results_go_to_stdout_and_the_rest_to_stderr() {
    let folder = scratch("streams");
    let outcome = interplay(&folder, &["run", "--set", "duration_s=2", "--record", "my.rrd"]);
    assert!(outcome.stdout.contains("FAIL completes.ego: wanted: ego reaches its goal"), "{}", outcome.stdout);
    let (place, command) = outcome.stderr.split_once("; to open it: ").expect("two parts");
    // The program is called as the shell would find it.
    assert_eq!((place, command.ends_with(" view my.rrd\n")), ("recorded to my.rrd", true), "{command}");
}

#[test]
fn piped_output_has_no_colour_and_no_color_is_respected() {
    let folder = scratch("colour");
    let complaint = |variables: &[(&str, &str)]| -> Outcome {
        let mut command = command(&folder, &["run", "nowhere"]);
        command.envs(variables.iter().copied()).output().expect("the command can be started").into()
    };
    let coloured = |outcome: Outcome| outcome.stderr.contains('\u{1b}');
    assert!(!coloured(complaint(&[])));
    // As on a terminal that knows colours.
    let terminal = [("IGNORE_IS_TERMINAL", "1"), ("TERM", "xterm-256color"), ("COLORTERM", "truecolor")];
    assert!(coloured(complaint(&terminal)), "without colours there is nothing to switch off");
    assert!(!coloured(complaint(&[&terminal[..], &[("NO_COLOR", "1")]].concat())));
}

#[test]
fn list_names_every_authored_scenario() {
    let folder = scratch("list");
    let outcome = interplay(&folder, &["list"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    let (rows, headings): (Vec<&str>, Vec<&str>) =
        outcome.stdout.lines().filter(|line| !line.is_empty()).partition(|line| line.starts_with("  "));
    let names: Vec<&str> = rows.iter().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.iter().copied().eq(embedded().iter().map(|file| file.name)), "{names:?}");
    assert!(headings.contains(&"intersection") && headings.len() < names.len() / 2, "{headings:?}");
    let family = interplay(&folder, &["list", "intersection"]).stdout;
    let of_family = |line: &&str| line.starts_with("  intersection/");
    assert!(
        family.starts_with("intersection\n") && family.lines().filter(of_family).count() + 1 == family.lines().count()
    );
    assert_eq!(interplay(&folder, &["list", "nowhere"]).code, Some(2));
    let list = interplay(&folder, &["list", "--json"]).json();
    for (row, file) in list.as_array().expect("a list").iter().zip(embedded()) {
        has_keys(row, "name title shows figure");
        assert_eq!(row["name"], file.name);
    }
}

#[test]
fn check_accepts_every_authored_scenario_as_a_file() {
    let folder = scratch("check-authored");
    for file in embedded() {
        let path = folder.join(format!("{}.toml", file.name));
        fs::create_dir_all(path.parent().expect("a file is in a folder")).expect("a folder can be made");
        fs::write(path, file.text).expect("a scratch file can be written");
    }
    let outcome = interplay(&folder, &["check", "."]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    let (fine, notes): (Vec<&str>, Vec<&str>) = outcome.stdout.lines().partition(|line| line.starts_with("ok  "));
    let (of_others, notes): (Vec<&str>, Vec<&str>) = notes.into_iter().partition(|line| line.starts_with("    its "));
    assert!(of_others.iter().all(|line| line.contains("counterfactual")), "{}", outcome.stdout);
    let (costs, notes): (Vec<&str>, Vec<&str>) = notes.into_iter().partition(|line| line.starts_with("    makes "));
    assert_eq!((fine.len(), costs.len()), (embedded().len(), embedded().len()), "{}", outcome.stdout);
    // On the motorway plans of 6 s end up to 1 s before a car could stop; their figures are as they were measured.
    let is_known = |note: &&str| note.contains("note: plans reach 6 s ahead") && note.contains("full-size/lane-");
    assert!(notes.iter().all(is_known), "{}", outcome.stdout);
}

#[test]
fn every_help_text_has_an_example() {
    let folder = scratch("help");
    for subcommand in ["run", "list", "check", "suite", "why"] {
        let outcome = interplay(&folder, &[subcommand, "--help"]);
        assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
        assert!(outcome.stdout.contains(&format!("\n  interplay {subcommand}")), "{}", outcome.stdout);
    }
    assert!(interplay(&folder, &["--help"]).stdout.contains("Exit codes: 0 all well"));
}

/// As in `interplay list | head -0`.
#[test]
fn a_closed_output_pipe_is_not_an_error() {
    let folder = scratch("closed-pipe");
    let mut child = command(&folder, &["list", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command can be started");
    drop(child.stdout.take());
    let outcome: Outcome = child.wait_with_output().expect("the command ends").into();
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
}

/// An expectation of a figure says on which day it was worst, and in which room.
#[test]
fn a_failed_expectation_of_a_building_names_day_and_room() {
    let folder = scratch("building-worst");
    let flags = ["--no-record", "--set", "iterations=3", "--set", "expect.building.tracking_rmse_c_at_most=0.001"];
    let run = |more: &[&str]| interplay(&folder, &[&["run", "building/four-room-pid"], &flags[..], more].concat());
    let printed = run(&[]).stdout;
    let line = printed.lines().find(|line| line.contains("building.tracking_rmse_c_at_most")).expect("it is judged");
    assert!(line.contains("FAIL") && line.contains("(day "), "{line}");
    let report = run(&["--json"]).json();
    let days = report["building"]["iterations"].as_array().expect("days").iter();
    let each: Vec<f64> = days.filter_map(|day| day["tracking_rmse_c"].as_f64()).collect();
    let at = report["expectations"].as_array().expect("expectations").iter().find_map(|one| one["at"].as_str());
    let (day, room) = at.and_then(|at| at.strip_prefix("day ")?.split_once(", most in ")).expect("a day and a room");
    let worst = each.iter().copied().fold(0.0, f64::max);
    let day: usize = day.parse().expect("a number");
    assert!((each[day - 1] - worst).abs() < 1e-12, "{each:?}, {day}");
    assert!(!room.is_empty() && line.contains(room), "{line}");
}
