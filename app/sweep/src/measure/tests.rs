//! A row agrees with the report of its run.

use std::collections::BTreeMap;
use std::error::Error;
use std::panic::catch_unwind;
use std::path::Path;

use interplay_scenarios::{Override, Scenario, SweepPlan, load};
use interplay_simulation::frame::Collision;
use interplay_simulation::measure::{MetricValue, Passage};
use interplay_simulation::report::{BuildingReport, Expectation, Report, VehicleReport};
use interplay_simulation::run::run;
use serde_json::{Value as Json, json};

use super::*;

const CONSERVATIVE: &str = "vehicle.ego.driver={kind='conservative'}";

type Outcome = Result<(), Box<dyn Error>>;

/// A built-in scenario and a run of its first tick, whose report the tests change.
fn short(name: &str, changes: &[&str]) -> Result<(Scenario, Report), Box<dyn Error>> {
    let changes: Vec<Override> = changes.iter().map(|change| Override::Set((*change).to_owned())).collect();
    let scenario = load(name, &changes)?;
    let report = run(name, &scenario, Vec::new())?;
    Ok((scenario, report))
}

/// Three vehicles on two lanes: the ego, which changes its lane, and two others that keep theirs.
fn three_vehicles() -> Result<(Scenario, Report), Box<dyn Error>> {
    short("lane-change/front-nice", &["duration_s=0.1", "expect.completes=[]", CONSERVATIVE])
}

type Values = BTreeMap<String, Json>;

fn measured(scenario: &Scenario, report: &Report) -> Result<Values, &'static str> {
    result(scenario, report).traffic.ok_or("there is an ego")
}

/// Compares some columns of a row with expected values.
#[track_caller]
fn has(row: &Values, values: Json) {
    for (name, value) in values.as_object().into_iter().flatten() {
        assert_eq!(row.get(name), Some(value), "{name}");
    }
}

/// Replaces the value of a vehicle's metric.
fn set(vehicle: &mut VehicleReport, name: &str, value: MetricValue) {
    for (_, measured) in vehicle.metrics.0.iter_mut().filter(|(declaration, _)| declaration.name == name) {
        measured.value = Some(value);
    }
}

fn touch(between: [&str; 2], time_s: f64, impulse_ns: f64) -> Collision {
    Collision { time_s, between: between.map(str::to_owned), impulse_ns, fault: None }
}

fn expectation(what: &str, passed: bool) -> Expectation {
    Expectation { what: what.to_owned(), want: Json::Null, got: Json::Null, passed, at: None }
}

#[test]
fn the_message_of_a_panic_becomes_the_error_of_the_run() {
    let words = |panic: fn()| catch_unwind(panic).map_err(|panic| message(&*panic).to_owned());
    let said = std::hint::black_box("made of parts");
    assert_eq!(message(&said.to_owned()), said);
    assert_eq!(words(|| std::panic::panic_any("plain")), Err("plain".to_owned()));
    assert_eq!(words(|| std::panic::panic_any(String::from("of a string"))), Err("of a string".to_owned()));
    assert_eq!(words(|| std::panic::panic_any(7_u8)), Err("without a message".to_owned()));
}

#[test]
fn success_is_a_completed_task_without_contact_of_the_ego() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let of = |report: &Report| {
        measured(&scenario, report).map(|row| (row["success"] == json!(true), row["deadlock"] == json!(true)))
    };
    assert!(report.vehicles[0].has_task && report.vehicles[0].completed_s.is_none());
    assert_eq!(of(&report)?, (false, true), "it goes on for ever");
    report.collisions = vec![touch(["front", "rear"], 1.0, 1.0)];
    assert_eq!(of(&report)?, (false, false), "others block the road");
    report.vehicles[0].completed_s = Some(2.0);
    assert_eq!(of(&report)?, (true, false), "others touch each other");
    report.collisions.push(touch(["ego", "rear"], 3.0, 1.0));
    assert_eq!(of(&report)?, (false, false), "the ego touches one");
    report.collisions.clear();
    assert_eq!(of(&report)?, (true, false));
    report.vehicles[0].completed_s = None;
    report.vehicles[0].has_task = false;
    assert_eq!(of(&report)?, (true, false), "there is nothing to do");
    Ok(())
}

/// A vehicle that keeps no rules of the road is not judged by them.
#[test]
fn success_of_a_rule_keeping_ego_needs_more_than_its_task() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    report.vehicles[0].completed_s = Some(2.0);
    report.vehicles[0].scale = 1.0;
    let is_success = |report: &Report| measured(&scenario, report).map(|row| row["success"] == json!(true));
    let faults = [
        ("off_road_m", MetricValue::Number(0.04), MetricValue::Number(0.06)),
        ("rules_broken", MetricValue::Count(0), MetricValue::Count(1)),
        ("deadlocks", MetricValue::Count(0), MetricValue::Count(1)),
    ];
    for (name, good, bad) in faults {
        set(&mut report.vehicles[1], name, bad);
        for (value, keeps_rules, wanted) in [(good, true, true), (bad, true, false), (bad, false, true)] {
            set(&mut report.vehicles[0], name, value);
            report.vehicles[0].keeps_rules = keeps_rules;
            assert_eq!(is_success(&report)?, wanted, "{name}: {value:?}, rules kept: {keeps_rules}");
        }
        set(&mut report.vehicles[0], name, good);
    }
    Ok(())
}

#[test]
fn contacts_of_the_ego_are_counted_separately() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let none = measured(&scenario, &report)?;
    has(&none, json!({ "contacts": 0, "ego_contact": false, "ego_contact_s": null, "impulse_ns": null }));
    report.collisions =
        vec![touch(["front", "rear"], 1.0, 4.0), touch(["ego", "rear"], 3.0, 9.0), touch(["ego", "front"], 2.0, 5.0)];
    let row = measured(&scenario, &report)?;
    has(&row, json!({ "contacts": 3, "ego_contact": true, "ego_contact_s": 2.0, "impulse_ns": 9.0 }));
    Ok(())
}

#[test]
fn columns_about_other_vehicles_exclude_the_ego() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    for (index, vehicle) in report.vehicles.iter_mut().enumerate() {
        vehicle.has_task = true;
        vehicle.plans.failed = 1 << index;
        vehicle.plans.count = 10 + index;
        vehicle.plans.unfinished = 20 + index;
        set(vehicle, "peak_braking_mps2", MetricValue::Number(0.1 * (index + 1) as f64));
        set(vehicle, "hard_braking", MetricValue::Flag(index == 1));
    }
    report.vehicles[2].completed_s = Some(4.0);
    let row = measured(&scenario, &report)?;
    has(&row, json!({ "plans": 10, "plans_failed": 1, "plans_unfinished": 20, "others_plans_failed": 2 + 4 }));
    has(&row, json!({ "others_with_task": 2, "others_completed": 1 }));
    has(&row, json!({ "peak_braking_mps2": 0.1, "hard_braking": false }));
    has(&row, json!({ "others_peak_braking_mps2": 0.1 * 3.0, "others_hard_braking": true }));
    report.vehicles[2].has_task = false;
    let row = measured(&scenario, &report)?;
    // A vehicle without a task does not complete one.
    has(&row, json!({ "others_with_task": 1, "others_completed": 0 }));
    Ok(())
}

#[test]
fn the_order_is_kept_if_order_expectations_hold_without_contact() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let mut kept = |expectations: &[(&str, bool)], contact: bool| {
        report.expectations = expectations.iter().map(|(what, passed)| expectation(what, *passed)).collect();
        report.collisions = if contact { vec![touch(["front", "rear"], 1.0, 1.0)] } else { Vec::new() };
        measured(&scenario, &report).map(|row| row["order_kept"].as_bool())
    };
    assert_eq!(kept(&[], false)?, None);
    assert_eq!(kept(&[("min_gap_m", true), ("completes.ego", false)], true)?, None, "no expectation of order");
    for what in ["order", "yields.ego.to.front"] {
        assert_eq!(kept(&[(what, true), ("min_gap_m", false)], false)?, Some(true), "{what}: others do not count");
        assert_eq!(kept(&[("min_gap_m", true), (what, false)], false)?, Some(false), "{what}");
        assert_eq!(kept(&[(what, true)], true)?, Some(false), "{what}, with a contact");
    }
    assert_eq!(kept(&[("order", true), ("yields.ego.to.front", false)], false)?, Some(false), "both count");
    Ok(())
}

#[test]
fn the_place_of_the_ego_on_a_road_is_its_rank_in_the_passing_order() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    for (order, place) in [(vec!["ego", "front"], 1), (vec!["front", "rear", "ego"], 3), (vec!["front"], 0)] {
        report.order = order.into_iter().map(str::to_owned).collect();
        let row = measured(&scenario, &report)?;
        has(&row, json!({ "ego_place": place, "ego_yields": 0, "others_yield": 0 }));
    }
    Ok(())
}

#[test]
fn the_place_of_the_ego_on_a_network_counts_vehicles_that_went_first() -> Outcome {
    let changes = ["duration_s=0.4", "expect.completes=[]", CONSERVATIVE];
    let (scenario, mut report) = short("t-junction/bayesian-nice", &changes)?;
    assert!(scenario.network.is_some());
    let passage = |[first, second]: [&str; 2]| Passage {
        first: first.to_owned(),
        second: second.to_owned(),
        first_s: 1.0,
        second_s: Some(2.0),
        post_encroachment_s: Some(0.0),
        yielded: first == "a",
    };
    report.right_of_way =
        [["a", "ego"], ["b", "ego"], ["ego", "c"], ["ego", "d"], ["ego", "e"], ["a", "b"]].map(passage).to_vec();
    let row = measured(&scenario, &report)?;
    has(&row, json!({ "ego_place": 3, "ego_yields": 2, "others_yield": 3 }));
    report.vehicles[scenario.ego_index()].keeps_rules = true;
    let row = measured(&scenario, &report)?;
    has(&row, json!({ "ego_place": 3, "ego_yields": 1, "others_yield": 3 }));
    Ok(())
}

#[test]
fn the_row_of_a_building_has_the_sums_of_its_days() -> Outcome {
    let (scenario, mut whole) = short("building/four-room-pid", &["iterations=3"])?;
    let report = whole.building.as_mut().ok_or("it has a building")?;
    for (index, day) in report.iterations.iter_mut().enumerate() {
        let figures = &mut day.figures;
        let factor = 10_f64.powi(i32::try_from(index)?);
        (figures.energy_kwh, figures.electricity_kwh) = (factor, 2.0 * factor);
        (figures.energy_cost, figures.discomfort_k_h, figures.cost) = (Some(3.0 * factor), 4.0 * factor, 5.0 * factor);
    }
    report.currency = None;
    let row = |report: &BuildingReport| building_values(report).collect::<Values>();
    has(&row(report), json!({ "controller": "pid", "days": 3, "energy_kwh": 111.0, "electricity_kwh": 222.0 }));
    has(&row(report), json!({ "discomfort_k_h": 444.0, "last_cost": 500.0, "bill": null, "currency": null }));
    report.currency = Some("€".to_owned());
    has(&row(report), json!({ "bill": 333.0, "currency": "€" }));
    report.iterations.clear();
    has(&row(report), json!({ "last_cost": 0.0 }));
    let row = result(&scenario, &whole);
    assert!(row.traffic.is_none() && row.building.is_some_and(|of| of["controller"] == "pid"));
    Ok(())
}

#[test]
fn every_run_of_a_plan_becomes_a_row() -> Outcome {
    let text =
        "scenario = ['intersection/nice']\nplanner = ['conservative']\nsamples = 2\njitter = { speed_mps = 0.01 }\n";
    let plan = SweepPlan::from_text("one.toml", text, Path::new(""))?;
    let point = plan.point(1);
    let scenario = plan.scenario(&point)?;
    let key = RunKey::of(&plan, &point);
    let row = measured_run(key, &point, &scenario, None).expect("no file is written");
    let labels = [&row.scenario, &row.family, &row.style, &row.planner];
    assert_eq!(labels, [&point.scenario, &point.family, &point.style, &point.planner]);
    assert_eq!((row.key, row.sample, row.seed, row.error.as_ref()), (key, point.sample, point.seed, None));
    assert_eq!(row.inputs, point.inputs.into_iter().collect());
    let traffic = row.result.and_then(|result| result.traffic).ok_or("it has traffic")?;
    assert!(row.wall_s > 0.0 && row.plan_median_ms > Some(0.0) && row.plan_p99_ms >= row.plan_median_ms);
    assert!(traffic["plans"].as_u64() > Some(0) && traffic["driver"] == "conservative");
    Ok(())
}
