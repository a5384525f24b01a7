//! A row says of a run what its report says.

use std::error::Error;
use std::panic::catch_unwind;
use std::path::Path;

use interplay_scenarios::{Override, Scenario, SweepPlan, load};
use interplay_simulation::frame::{Collision, Frame, VehicleFrame};
use interplay_simulation::measure::{Fallback, Passage};
use interplay_simulation::report::{Expectation, Report};
use interplay_simulation::run::run;
use interplay_simulation::watch::Watcher;
use serde_json::Value as Json;

use super::*;

const CONSERVATIVE: &str = "vehicle.ego.driver={kind='conservative'}";

type Outcome = Result<(), Box<dyn Error>>;

/// A scenario of the binary and a run of its first tick, whose report the tests change.
fn short(name: &str, changes: &[&str]) -> Result<(Scenario, Report), Box<dyn Error>> {
    let changes: Vec<Override> = changes.iter().map(|change| Override::Set((*change).to_owned())).collect();
    let scenario = load(name, &changes)?;
    let report = run(name, &scenario, Vec::new())?;
    Ok((scenario, report))
}

/// Three vehicles on two lanes: the ego, which changes its lane, and two others, which keep theirs.
fn three_vehicles() -> Result<(Scenario, Report), Box<dyn Error>> {
    short("lane-change/front-nice", &["duration_s=0.1", "expect.completes=[]", CONSERVATIVE])
}

fn measured(scenario: &Scenario, report: &Report) -> Result<TrafficResult, &'static str> {
    result(scenario, report, false).traffic.ok_or("there is an ego")
}

fn touch(between: [&str; 2], time_s: f64, impulse_ns: f64) -> Collision {
    Collision { time_s, between: between.map(str::to_owned), impulse_ns }
}

fn expectation(what: &str, passed: bool) -> Expectation {
    Expectation { what: what.to_owned(), want: Json::Null, got: Json::Null, passed, at: None }
}

#[test]
fn the_words_of_a_panic() {
    let words = |panic: fn()| catch_unwind(panic).map_err(|panic| message(&*panic).to_owned());
    let said = std::hint::black_box("made of parts");
    assert_eq!(message(&said.to_owned()), said);
    assert_eq!(words(|| std::panic::panic_any("plain")), Err("plain".to_owned()));
    assert_eq!(words(|| std::panic::panic_any(String::from("of a string"))), Err("of a string".to_owned()));
    assert_eq!(words(|| std::panic::panic_any(7_u8)), Err("without a message".to_owned()));
}

#[test]
fn success_is_a_task_done_without_contact_of_the_ego() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let of = |report: &Report| measured(&scenario, report).map(|row| (row.success, row.deadlock));
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

#[test]
fn contacts_of_the_ego_and_of_others() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let none = measured(&scenario, &report)?;
    assert_eq!((none.contacts, none.ego_contact, none.ego_contact_s, none.impulse_ns), (0, false, None, None));
    report.collisions =
        vec![touch(["front", "rear"], 1.0, 4.0), touch(["ego", "rear"], 3.0, 9.0), touch(["ego", "front"], 2.0, 5.0)];
    let row = measured(&scenario, &report)?;
    assert_eq!((row.contacts, row.ego_contact, row.ego_contact_s, row.impulse_ns), (3, true, Some(2.0), Some(9.0)));
    Ok(())
}

#[test]
fn what_the_others_do_is_not_what_the_ego_does() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let limits_mps2 = scenario.vehicles.iter().map(|vehicle| -vehicle.limits.acceleration_min_mps2);
    let limits_mps2: Vec<f64> = limits_mps2.collect();
    for (index, vehicle) in report.vehicles.iter_mut().enumerate() {
        vehicle.has_task = true;
        vehicle.plans.failed = 1 << index;
        vehicle.plans.count = 10 + index;
        vehicle.plans.unfinished = 20 + index;
        vehicle.peak_braking_mps2 = 0.1 * (index + 1) as f64 * limits_mps2[index];
    }
    report.vehicles[2].completed_s = Some(4.0);
    let row = measured(&scenario, &report)?;
    assert_eq!((row.plans, row.plans_failed, row.plans_unfinished), (10, 1, 20));
    assert_eq!(row.others_plans_failed, 2 + 4);
    assert_eq!((row.others_with_task, row.others_completed), (2, 1));
    assert_eq!(row.others_peak_braking_mps2, Some(report.vehicles[2].peak_braking_mps2));
    report.vehicles[2].has_task = false;
    let row = measured(&scenario, &report)?;
    assert_eq!((row.others_with_task, row.others_completed), (1, 0), "who has no task completes none");
    Ok(())
}

#[test]
fn braking_is_hard_from_three_quarters_of_the_strongest_on() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let strongest_mps2 = |index: usize| -scenario.vehicles[index].limits.acceleration_min_mps2;
    for (share, is_hard) in [(0.5, false), (0.7499, false), (0.75, true), (1.0, true)] {
        for (braking, other) in [(0, 1), (1, 0)] {
            report.vehicles[braking].peak_braking_mps2 = share * strongest_mps2(braking);
            report.vehicles[other].peak_braking_mps2 = 0.1 * strongest_mps2(other);
            let row = measured(&scenario, &report)?;
            let ego_share = if braking == 0 { share } else { 0.1 };
            assert!((row.peak_braking_share - ego_share).abs() < 1e-12, "{share}: {}", row.peak_braking_share);
            let expected = if braking == 0 { [is_hard, false] } else { [false, is_hard] };
            assert_eq!([row.hard_braking, row.others_hard_braking], expected, "{share} by vehicle {braking}");
        }
    }
    let stranger = VehicleReport { name: "nobody".to_owned(), ..report.vehicles[0].clone() };
    assert!(braking_share(&scenario, &stranger).abs() < 1e-300, "its strongest braking is not known");
    Ok(())
}

#[test]
fn it_leaves_the_road_by_more_than_three_hundredths_of_its_width() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    let width_m = scenario.vehicles[0].body.width_m;
    for (widths, leaves) in [(0.0, false), (0.029, false), (0.031, true), (1.0, true)] {
        report.vehicles[0].off_road_m = widths * width_m;
        assert_eq!(measured(&scenario, &report)?.leaves_road, leaves, "{widths} of its width");
    }
    report.vehicles[0].off_road_m = OFF_ROAD_WIDTHS * width_m;
    assert!(!measured(&scenario, &report)?.leaves_road, "up to the bound it is on the road");
    Ok(())
}

#[test]
fn order_is_kept_if_all_of_it_is_and_nobody_touches() -> Outcome {
    let (_, mut report) = three_vehicles()?;
    let mut kept = |expectations: &[(&str, bool)], contact: bool| {
        report.expectations = expectations.iter().map(|(what, passed)| expectation(what, *passed)).collect();
        report.collisions = if contact { vec![touch(["front", "rear"], 1.0, 1.0)] } else { Vec::new() };
        order_kept(&report)
    };
    assert_eq!(kept(&[], false), None);
    assert_eq!(kept(&[("min_gap_m", true), ("completes.ego", false)], true), None, "nothing is said of order");
    for what in ["order", "yields.ego.to.front"] {
        assert_eq!(kept(&[(what, true), ("min_gap_m", false)], false), Some(true), "{what}: others do not count");
        assert_eq!(kept(&[("min_gap_m", true), (what, false)], false), Some(false), "{what}");
        assert_eq!(kept(&[(what, true)], true), Some(false), "{what}, with a contact");
    }
    assert_eq!(kept(&[("order", true), ("yields.ego.to.front", false)], false), Some(false), "both count");
    Ok(())
}

#[test]
fn the_place_on_a_road_is_that_in_the_order() -> Outcome {
    let (scenario, mut report) = three_vehicles()?;
    for (order, place) in [(vec!["ego", "front"], 1), (vec!["front", "rear", "ego"], 3), (vec!["front"], 0)] {
        report.order = order.into_iter().map(str::to_owned).collect();
        let row = measured(&scenario, &report)?;
        assert_eq!((row.ego_place, row.ego_yields, row.others_yield), (place, 0, 0), "{:?}", row.order);
    }
    Ok(())
}

#[test]
fn the_place_on_a_network_counts_those_who_went_first() -> Outcome {
    let changes = ["duration_s=0.4", "expect.completes=[]", CONSERVATIVE];
    let (scenario, mut report) = short("t-junction/bayesian-nice", &changes)?;
    assert!(scenario.network.is_some());
    let passage = |[first, second]: [&str; 2]| Passage {
        first: first.to_owned(),
        second: second.to_owned(),
        first_s: 1.0,
        second_s: None,
    };
    report.right_of_way =
        [["a", "ego"], ["b", "ego"], ["ego", "c"], ["ego", "d"], ["ego", "e"], ["a", "b"]].map(passage).to_vec();
    let row = measured(&scenario, &report)?;
    assert_eq!((row.ego_place, row.ego_yields, row.others_yield), (3, 2, 3));
    Ok(())
}

#[test]
fn a_building_has_the_sums_of_its_days() -> Outcome {
    let (scenario, mut whole) = short("building/four-room-pid", &["iterations=3"])?;
    let report = whole.building.as_mut().ok_or("it has a building")?;
    for (index, day) in report.iterations.iter_mut().enumerate() {
        let figures = &mut day.figures;
        let factor = 10_f64.powi(i32::try_from(index)?);
        (figures.energy_kwh, figures.electricity_kwh) = (factor, 2.0 * factor);
        (figures.energy_cost, figures.discomfort_k_h, figures.cost) = (Some(3.0 * factor), 4.0 * factor, 5.0 * factor);
        day.fallback = index > 0;
    }
    report.currency = None;
    report.fallbacks = vec![Fallback { day: 1, reason: "not counted from here".to_owned() }];
    let row = building(report);
    assert_eq!((row.controller.as_str(), row.days, row.fallbacks), ("pid", 3, 2));
    assert_eq!([row.energy_kwh, row.electricity_kwh, row.discomfort_k_h, row.last_cost], [111.0, 222.0, 444.0, 500.0]);
    assert_eq!((row.bill, row.currency), (None, None), "there is no tariff");
    report.currency = Some("€".to_owned());
    let row = building(report);
    assert_eq!((row.bill, row.currency.as_deref()), (Some(333.0), Some("€")));
    report.iterations.clear();
    assert_eq!(building(report).last_cost.to_bits(), 0);
    let row = result(&scenario, &whole, false);
    assert!(row.traffic.is_none() && row.building.is_some_and(|of| of.controller == "pid"));
    Ok(())
}

/// A vehicle that drives along the road.
fn at(name: &str, x_m: f64, speed_mps: f64) -> VehicleFrame {
    let mut vehicle = VehicleFrame { name: name.to_owned(), ..VehicleFrame::default() };
    vehicle.state.x_m = x_m;
    vehicle.state.speed_mps = speed_mps;
    vehicle
}

#[test]
fn the_first_contact_of_the_ego_says_who_drives_into_whom() -> Outcome {
    // The ego between one behind and one ahead of it, with its speed; one of the others touches it.
    let frame = |ego_mps: f64, between: [&str; 2]| Frame {
        vehicles: vec![at("behind", -1.0, 1.0), at("ego", 0.0, ego_mps), at("ahead", 1.0, 0.5)],
        collisions: vec![touch(between, 0.0, 1.0)],
        ..Frame::default()
    };
    let watched = |index: usize, frames: &[Frame]| -> Result<bool, WatchError> {
        let contact = EgoContact::default();
        let mut watcher = Box::new(ContactWatcher { ego: index, seen: contact.clone() });
        frames.iter().try_for_each(|frame| watcher.tick(frame))?;
        watcher.finish()?;
        Ok(contact.by_ego())
    };
    let [into, into_it] = [frame(1.0, ["ego", "ahead"]), frame(0.5, ["behind", "ego"])];
    assert!(watched(1, std::slice::from_ref(&into)).is_ok_and(|by_ego| by_ego), "into the one ahead");
    assert!(watched(1, std::slice::from_ref(&into_it)).is_ok_and(|by_ego| !by_ego), "the one behind into it");
    assert!(watched(1, &[frame(1.0, ["behind", "ahead"])]).is_ok_and(|by_ego| !by_ego), "others");
    let quiet = Frame { collisions: Vec::new(), ..into.clone() };
    assert!(watched(1, &[quiet, into.clone(), into_it.clone()]).is_ok_and(|by_ego| by_ego), "the first one counts");
    assert!(watched(1, &[into_it, into.clone()]).is_ok_and(|by_ego| !by_ego), "the first one counts");
    assert!(watched(7, &[into]).is_ok_and(|by_ego| !by_ego), "there is no such vehicle");
    Ok(())
}

#[test]
fn a_run_of_a_plan_has_a_row() -> Outcome {
    let text =
        "scenario = ['intersection/nice']\nplanner = ['conservative']\nsamples = 2\njitter = { speed_mps = 0.01 }\n";
    let plan = SweepPlan::from_text("one.toml", text, Path::new(""))?;
    let point = plan.point(1);
    let scenario = plan.scenario(&point)?;
    let key = RunKey::of(&plan, &point);
    let row = measured_run(key, &point, &scenario);
    let labels = [&row.scenario, &row.family, &row.style, &row.planner];
    assert_eq!(labels, [&point.scenario, &point.family, &point.style, &point.planner]);
    assert_eq!((row.key, row.sample, row.seed, row.error.as_ref()), (key, point.sample, point.seed, None));
    assert_eq!(row.inputs, point.inputs.into_iter().collect());
    let traffic = row.result.and_then(|result| result.traffic).ok_or("it has traffic")?;
    assert!(row.wall_s > 0.0 && row.plan_median_ms > Some(0.0) && row.plan_p99_ms >= row.plan_median_ms);
    assert!(traffic.plans > 0 && traffic.driver == "conservative");
    Ok(())
}
