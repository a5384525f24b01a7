//! Controllers that learn, through the whole application: their reports and expectations, in which measures
//! they are better than others, and how a run continues when their designs fail.

use std::fs;

use interplay_scenarios::embedded;
use interplay_simulation::frame::Level;
use serde_json::{Value, json};

use crate::command::{interplay, scratch};
use crate::film::{authored, film};

fn days(report: &Value) -> &Vec<Value> {
    report["building"]["iterations"].as_array().expect("a list")
}

fn report(test: &str, name: &str, more: &[&str]) -> Value {
    interplay(&scratch(test), &[&["run", name, "--no-record", "--json"], more].concat()).json()
}

/// The mean of a figure over the days after the first.
fn later(report: &Value, key: &str) -> f64 {
    let later = &days(report)[1..];
    later.iter().map(|day| day[key].as_f64().expect("a number")).sum::<f64>() / later.len() as f64
}

#[test]
fn the_report_of_an_exchange_has_rounds_messages_and_centralised_optimum() {
    let report = report("learn-exchange", "building/distributed", &[]);
    let days = days(&report);
    assert!(days[0].get("exchange").is_none(), "nothing is planned before there was a day");
    for day in &days[1..] {
        let spoken = &day["exchange"];
        let number = |key: &str| spoken[key].as_f64().unwrap_or_else(|| panic!("{key} in {spoken}"));
        assert!(number("rounds") >= 2.0 && number("undelivered") == 0.0);
        // Four rooms with two neighbours each; temperatures and sensitivities go around in every round, and directions up
        // to twice for the step.
        let per_round = number("messages") / number("rounds") / 8.0;
        assert!((2.0..=4.0).contains(&per_round), "{per_round}");
        assert!(number("cost") < number("first_cost") && number("cost") <= 1.001 * number("centralised_cost"));
        assert_eq!(spoken["never_rises"], true);
        assert!(day["spectral_radius"].is_number() && day["design_s"].as_f64() > Some(0.0));
    }
}

#[test]
fn the_designs_of_the_dissertation_beat_their_alternatives() {
    for seed in ["1", "2", "3"] {
        let of =
            |name: &str, key: &str| later(&report("learn-order", &format!("building/{name}"), &["--seed", seed]), key);
        for nights in ["warm", "free"] {
            let cost = |design: &str| of(&format!("{design}-{nights}-nights"), "cost");
            assert!(cost("iterative") < 0.9 * cost("fixed"), "{seed} {nights}");
        }
        for figure in ["tracking_rmse_c", "discomfort_k_h", "cost"] {
            let (youla, pid) = (of("concurrent-uncertain", figure), of("pid-uncertain", figure));
            assert!(youla < pid, "{seed} {figure}: {youla} {pid}");
        }
    }
}

/// Each scenario has an expectation that the same controller with a weaker setting does not meet.
#[test]
fn weaker_settings_fail_the_expectations_of_the_designs() {
    let rivals = [
        ("building/iterative-warm-nights", "controller.stability=fixed", "regret_at_most"),
        ("building/iterative-warm-nights", "controller.objective=nominal", "spectral_radius_at_most"),
        ("building/concurrent-uncertain", "controller.kind=pid", "tracking_rmse_c_at_most"),
        ("building/model-predictive", "controller.learning_rate=0.0", "regret_at_most"),
        ("building/model-predictive", "controller.kind=pid", "tracking_rmse_c_at_most"),
        ("building/office-and-flat", "setpoints.weigh_energy=false", "total_energy_cost_at_most"),
        ("building/office-and-flat", "controller.kind=pid", "discomfort_k_h_at_most"),
        ("building/distributed", "controller.kind=pid", "early_kwh_at_least"),
        ("building/distributed", "controller.rounds=1", "above_centralised_at_most"),
    ];
    for (name, change, what) in rivals {
        let report = report("learn-rivals", name, &["--set", change]);
        let judged = report["expectations"].as_array().expect("a list");
        let one = judged.iter().find(|one| one["what"] == format!("building.{what}")).expect("expected");
        assert_eq!((&one["passed"], &report["passed"]), (&json!(false), &json!(false)), "{name} {change}: {one}");
    }
}

/// The plan fails every day; the inputs of the day before are planned again (`building/tests/iterative.rs`), which is an event, is
/// counted and can be expected; the run continues.
#[test]
fn a_day_without_a_plan_is_logged_and_the_run_continues() {
    let changes =
        ["controller.uncertainty.common_kw=1e6", "controller.uncertainty.common_correlation=1", "iterations=3"];
    let film = film("building/iterative-warm-nights", authored("building/iterative-warm-nights", &changes));
    let events = film.frames.iter().flat_map(|frame| frame.events.iter().map(|event| (frame.tick, event)));
    let events: Vec<_> = events.filter(|(_, event)| event.level != Level::Note).collect();
    assert_eq!(events.iter().map(|(tick, _)| *tick).collect::<Vec<_>>(), [48, 96]);
    for (_, event) in &events {
        assert_eq!((event.vehicle.as_str(), event.level), ("controller", Level::Warning));
        assert!(event.text.contains("covariance"), "{}", event.text);
    }
    let building = film.report.building.as_ref().expect("a building");
    assert_eq!(building.fallbacks.iter().map(|fallback| fallback.day).collect::<Vec<_>>(), [2, 3]);
    assert!(building.iterations.iter().map(|day| day.fallback).eq([false, true, true]));
    let failed =
        film.report.expectations.iter().find(|one| one.what == "building.fallbacks_at_most").expect("expected");
    assert_eq!((failed.passed, &failed.got), (false, &json!(2)));
}

/// A covariance that is numerically none, and a price that leaves zones without a best answer.
#[test]
fn infeasible_controller_designs_give_a_reason() {
    let cases: [(&str, &[&str], &str); 2] = [
        (
            "building/iterative-warm-nights",
            &["--set", "controller.uncertainty.common_kw=1e6", "--set", "controller.uncertainty.common_correlation=1"],
            "covariance",
        ),
        ("building/distributed", &["--set", "setpoints.input_weight=0"], "none of the 4 zones"),
    ];
    for (name, changes, piece) in cases {
        let folder = scratch("learn-failing");
        let outcome = interplay(&folder, &[&["run", name, "--record", "it.rrd"], changes].concat());
        assert_eq!(outcome.code, Some(1), "{outcome:?}");
        assert!(outcome.stdout.contains("day 2 repeated the one before: "), "{outcome:?}");
        assert!(outcome.stdout.contains(piece), "{piece}: {outcome:?}");
        let bytes = fs::read(folder.join("it.rrd")).expect("recorded");
        assert!(bytes.windows(4).any(|window| window == b"/log"), "the event is in the recording");
    }
}

/// Designs that are certain to fail are refused before the run.
#[test]
fn controller_designs_that_must_fail_are_refused_on_loading() {
    let cases = [
        ("building/hundred-zones", "controller.kind=iterative", "use the distributed one"),
        ("building/concurrent-uncertain", "controller.gamma_2=3.0", "no feedback gets below 3.40"),
    ];
    for (name, change, piece) in cases {
        let folder = scratch("learn-refused");
        let outcome = interplay(&folder, &["run", name, "--record", "it.rrd", "--set", change]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(piece) && outcome.stderr.contains(change), "{outcome:?}");
        assert!(!folder.join("it.rrd").exists());
    }
}

#[test]
fn learning_controllers_keep_input_limits_and_precool_rooms() {
    let learners = ["iterative", "concurrent", "distributed", "fixed"];
    // Of the largest buildings the expectations in their files say as much, and they take long.
    let small = |name: &str| !name.ends_with("-hundred");
    let learns = |name: &str| learners.iter().any(|learner| name.starts_with(&format!("building/{learner}")));
    let all: Vec<&str> = embedded().iter().map(|file| file.name).filter(|name| learns(name) && small(name)).collect();
    assert!(all.len() >= 11, "{all:?}");
    for name in all {
        let film = film(name, authored(name, &[]));
        let zones = film.frames.iter().flat_map(|frame| &frame.building.as_ref().expect("a step").zones);
        assert!(zones.clone().all(|zone| zone.heat_kw.abs() <= 2.0), "{name}");
        let days = &film.report.building.as_ref().expect("a building").iterations;
        assert!(days[1..].iter().all(|day| day.early_kwh > 0.5), "{name}");
    }
}

#[test]
fn wrong_model_parameters_are_refused_at_their_line() {
    let folder = scratch("learn-belief");
    let text = "extends = 'building/iterative-warm-nights'\n[building]\nmethod = 'euler'\n[building.believed]\ncapacity_factor = ";
    for (value, pieces) in [
        ("0.0", ["my.toml:5:19", "at least 0.1"]),
        ("0.1\nouter_resistance_factor = 0.1", ["my.toml:4", "largest stable step"]),
    ] {
        fs::write(folder.join("my.toml"), format!("{text}{value}\n")).expect("written");
        let outcome = interplay(&folder, &["check", "my.toml"]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        for piece in pieces {
            assert!(outcome.stderr.contains(piece), "{piece}: {outcome:?}");
        }
    }
}
