//! Streets on which drivers do not behave as people do: queues, what stands, head-on traffic, junctions, overtaking.
//!
//! Each case states what is right. [`KNOWN_FAILURES`] lists those that are not right yet: a case on the list must fail, so that a
//! mechanism that mends it removes its line.

use std::path::Path;

use interplay_planners::State;
use interplay_planners::road::network::RightOfWay;
use interplay_scenarios::{Override, Scenario, load};
use rayon::prelude::*;

use crate::film::{Film, film};

/// A street, the drivers of its ego, and what is right on it.
struct Case {
    file: &'static str,
    /// The drivers of the ego, as `kind` or, for a human, as `human/style`.
    drivers: &'static [&'static str],
    /// What is wrong; `Ok` if all is right.
    right: fn(&Film) -> Result<(), String>,
}

/// The cases that are wrong today: file, driver of the ego, and why.
const KNOWN_FAILURES: &[(&str, &str, &str)] = &[
    ("parked-both-net", "human", "the last of three is past the rows after 44 s only"),
    ("parked-both-net", "idm", "it stands beside its row once an oncoming vehicle has come out of its lane"),
    ("parked-both-net", "conservative", "the last of three is past the rows after 42 s only"),
    ("parked-both-net", "negotiation", "the last of three is past the rows after 42 s only"),
    ("parked-both-net", "game", "the last of three is past the rows after 44 s only"),
    ("double-drop", "human", "drivers brake fully for those who want in"),
];

const ALL_KINDS: &[&str] = &["human", "idm", "conservative", "negotiation"];

const CASES: &[Case] = &[
    Case { file: "mini-red2", drivers: &["human"], right: |film| queues(film, "ego") },
    Case { file: "mini-zebra2", drivers: &["human"], right: |film| queues(film, "ego") },
    Case { file: "jam-2way", drivers: &["human"], right: |film| untouched(film).and(no_queue_is_passed(film)) },
    Case { file: "stop-and-go", drivers: &["negotiation"], right: untouched },
    Case { file: "mini-oncoming", drivers: &["human", "idm"], right: gives_way_to_a_wrong_way_driver },
    Case { file: "mini-backer", drivers: &["human"], right: untouched },
    Case {
        file: "mini-parked-west",
        drivers: ALL_KINDS,
        right: |film| {
            untouched(film).and(on_road(film)).and(ends(film, "ego", |last| last.x_m < -10.0, "past the van"))
        },
    },
    Case {
        file: "parked-both-net",
        drivers: &["human", "idm", "conservative", "negotiation", "game"],
        right: through_the_rows,
    },
    Case {
        file: "zip-works",
        drivers: &["human"],
        right: |film| {
            untouched(film).and(ends(film, "ego", |last| last.x_m > 250.0, "past the works")).and(at_most(
                film,
                "ego",
                "longest_astride_s",
                6.0,
            ))
        },
    },
    Case { file: "gate-3.5", drivers: &["human", "conservative"], right: through_the_gate },
    Case { file: "gate-2.9", drivers: &["human", "conservative"], right: through_the_gate },
    Case { file: "right-hook", drivers: ALL_KINDS, right: the_cyclist_rides_on },
    Case { file: "keep-clear", drivers: &["human"], right: junctions_are_clear },
    Case {
        file: "zebra-keep-clear",
        drivers: &["human", "conservative", "negotiation"],
        right: |film| junctions_are_clear(film).and(rules_are_kept(film)),
    },
    Case { file: "double-drop", drivers: &["human"], right: through_traffic_flows },
    Case {
        file: "tractor-queue",
        drivers: &["human"],
        right: |film| {
            untouched(film).and(at_most(film, "ego", "longest_oncoming_s", 10.0)).and(at_most(
                film,
                "mid",
                "longest_oncoming_s",
                10.0,
            ))
        },
    },
    Case {
        file: "tough-never-overtakes",
        drivers: &["human/tough", "human/assertive"],
        right: |film| {
            untouched(film).and(order(film, &["ego", "tractor"])).and(at_most(film, "ego", "longest_astride_s", 12.0))
        },
    },
    Case {
        file: "amber-stop",
        drivers: &["human"],
        right: |film| untouched(film).and(rests_behind(film, "behind")).and(no_deadlock(film)),
    },
    Case { file: "motorway-jam", drivers: &["human"], right: each_in_its_lane },
    Case { file: "handover-beside-middle", drivers: &["human"], right: the_other_returns },
    Case { file: "steering-rate-fork", drivers: &["conservative"], right: on_road },
    Case { file: "steering-rate-three-lanes", drivers: &["human"], right: on_road },
];

/// An imported map: its file, and whether it is right.
type Import = (&'static str, fn() -> Result<(), String>);

/// The cases of imported maps, whose driver in [`KNOWN_FAILURES`] is `import`.
const IMPORTS: [Import; 2] = [
    ("crosswalk-is-longest.xml", the_ego_starts_on_a_lane_for_vehicles),
    ("four-way-R1-3.xml", the_sign_is_an_all_way_stop),
];

const IMPORT: &str = "import";

fn street(file: &str, driver: &str) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/streets2/{file}.toml"));
    let driver = match driver.split_once('/') {
        Some((kind, style)) => format!("{{ kind = \"{kind}\", style = \"{style}\" }}"),
        None => format!("{{ kind = \"{driver}\" }}"),
    };
    let change = Override::Set(format!("vehicle.ego.driver={driver}"));
    load(path.to_str().expect("a path of text"), &[change])
        .unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
}

fn metric(film: &Film, vehicle: &str, name: &str) -> Option<f64> {
    film.report.vehicle(vehicle).unwrap_or_else(|| panic!("there is no {vehicle}")).metrics.number(name)
}

fn states(film: &Film, vehicle: &str) -> Vec<State> {
    let index = film.scenario.index_of(vehicle).unwrap_or_else(|| panic!("there is no {vehicle}"));
    film.frames.iter().map(|frame| frame.vehicles[index].state).collect()
}

fn names(film: &Film) -> impl Iterator<Item = &str> {
    film.report.vehicles.iter().filter(|vehicle| !vehicle.is_obstacle).map(|vehicle| vehicle.name.as_str())
}

fn hold(is_right: bool, wrong: impl Fn() -> String) -> Result<(), String> {
    if is_right { Ok(()) } else { Err(wrong()) }
}

fn untouched(film: &Film) -> Result<(), String> {
    hold(film.report.collisions.is_empty(), || format!("{:?}", film.report.collisions))
}

fn no_deadlock(film: &Film) -> Result<(), String> {
    hold(film.report.deadlocks.is_empty(), || format!("{:?}", film.report.deadlocks))
}

fn rules_are_kept(film: &Film) -> Result<(), String> {
    hold(film.report.broken_rules.is_empty(), || format!("{:?}", film.report.broken_rules))
}

fn at_most(film: &Film, vehicle: &str, name: &str, most: f64) -> Result<(), String> {
    let value = metric(film, vehicle, name).unwrap_or_default();
    hold(value <= most, || format!("{vehicle}: {name} is {value}, more than {most}"))
}

fn on_road(film: &Film) -> Result<(), String> {
    at_most(film, "ego", "off_road_m", 0.05)
}

fn order(film: &Film, wanted: &[&str]) -> Result<(), String> {
    hold(film.report.order_of_driven() == wanted, || format!("{:?}", film.report.order))
}

fn ends(film: &Film, vehicle: &str, there: fn(&State) -> bool, place: &str) -> Result<(), String> {
    let last = film.report.vehicle(vehicle).expect("a vehicle").last;
    hold(there(&last), || format!("{vehicle} is not {place} at the end: {last:?}"))
}

fn no_queue_is_passed(film: &Film) -> Result<(), String> {
    names(film).try_for_each(|name| at_most(film, name, "oncoming_past_queue_s", 0.0))
}

/// Stands behind another vehicle with a gap as people leave: 2 to 4 m, with half a metre of tolerance.
fn rests_behind(film: &Film, vehicle: &str) -> Result<(), String> {
    let [least_m, largest_m] = ["min_gap_at_rest_m", "max_gap_at_rest_m"].map(|name| metric(film, vehicle, name));
    let is_right = least_m.zip(largest_m).is_some_and(|(least_m, largest_m)| least_m >= 1.5 && largest_m <= 4.5);
    hold(is_right, || format!("{vehicle} stands {least_m:?} to {largest_m:?} m behind the next vehicle"))
}

fn queues(film: &Film, vehicle: &str) -> Result<(), String> {
    untouched(film).and(no_queue_is_passed(film)).and(rules_are_kept(film)).and(rests_behind(film, vehicle))
}

fn junctions_are_clear(film: &Film) -> Result<(), String> {
    untouched(film).and(names(film).try_for_each(|name| at_most(film, name, "blocks_junction_s", 0.5)))
}

/// When both are nearest, the ego is slow and at the right edge of its lane, whose right edge is at −3.5 m.
fn gives_way_to_a_wrong_way_driver(film: &Film) -> Result<(), String> {
    let [own, theirs] = ["ego", "overtaker"].map(|name| states(film, name));
    let meeting = own.iter().zip(&theirs).find(|(own, theirs)| theirs.x_m - own.x_m < 5.0);
    let Some((own, _)) = meeting else { return Err("they do not meet".to_owned()) };
    let to_edge_m = own.y_m - 0.9 + 3.5;
    hold(own.speed_mps < 5.0 && to_edge_m < 0.5, || format!("{to_edge_m} m from the edge, {own:?}"))
}

fn through_the_gate(film: &Film) -> Result<(), String> {
    untouched(film).and(on_road(film)).and(ends(film, "ego", |last| last.x_m > 10.0, "through the gate"))
}

/// All are past both rows after 40 s, without contact.
fn through_the_rows(film: &Film) -> Result<(), String> {
    untouched(film)?;
    let tick = (40.0 / film.scenario.step_s) as usize;
    for (name, is_east) in [("ego", true), ("o1", false), ("o2", false), ("o3", false)] {
        let state = states(film, name)[tick];
        let is_through = if is_east { state.x_m > 200.0 } else { state.x_m < 60.0 };
        hold(is_through, || format!("{name} is not through after 40 s: {state:?}"))?;
    }
    Ok(())
}

/// The cyclist, who rides straight on at 6 m/s beside the turning ego, need not brake for it.
fn the_cyclist_rides_on(film: &Film) -> Result<(), String> {
    let least_mps = metric(film, "cyclist", "min_speed_mps").unwrap_or_default();
    untouched(film)?;
    hold(least_mps > 4.5, || format!("the cyclist slows down to {least_mps} m/s"))
}

/// The vehicles of the through lane, which drive 21 m/s, slow down by 5 m/s at most.
fn through_traffic_flows(film: &Film) -> Result<(), String> {
    untouched(film)?;
    ["l1", "l2", "l3"].into_iter().try_for_each(|name| {
        let least_mps = metric(film, name, "min_speed_mps").unwrap_or_default();
        hold(least_mps >= 16.0, || format!("{name} slows down to {least_mps} m/s"))
    })
}

/// A change of lanes takes at most 6 s.
fn each_in_its_lane(film: &Film) -> Result<(), String> {
    untouched(film).and(names(film).try_for_each(|name| at_most(film, name, "longest_astride_s", 6.0)))
}

/// The middle of its lane is at 1.75 m.
fn the_other_returns(film: &Film) -> Result<(), String> {
    untouched(film).and(ends(film, "other", |last| (last.y_m - 1.75).abs() < 0.3, "in the middle of its lane"))
}

/// What contradicts the list of known failures; none if the case is on it and wrong, or not on it and right.
fn contradiction(file: &str, driver: &str, outcome: Result<(), String>) -> Option<String> {
    let known = KNOWN_FAILURES.iter().find(|(known, by, _)| (*known, *by) == (file, driver));
    match (outcome, known) {
        (Ok(()), Some(_)) => Some(format!("{file} with {driver} is right now: remove its line")),
        (Err(wrong), None) => Some(format!("{file} with {driver}: {wrong}")),
        _ => None,
    }
}

#[test]
fn every_case_is_right_or_a_known_failure() {
    let runs: Vec<(&Case, &str)> =
        CASES.iter().flat_map(|case| case.drivers.iter().map(move |driver| (case, *driver))).collect();
    let driven = runs.par_iter().filter_map(|(case, driver)| {
        let outcome = (case.right)(&film(case.file, street(case.file, driver)));
        contradiction(case.file, driver, outcome)
    });
    let mut wrong: Vec<String> = driven.collect();
    wrong.extend(IMPORTS.iter().filter_map(|(file, right)| contradiction(file, IMPORT, right())));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Each line of the list is about a case.
#[test]
fn known_failures_are_cases() {
    for (file, driver, _) in KNOWN_FAILURES {
        let is_driven = CASES.iter().any(|case| case.file == *file && case.drivers.contains(driver));
        let is_imported = *driver == IMPORT && IMPORTS.iter().any(|(import, _)| import == file);
        assert!(is_driven || is_imported, "{file} with {driver}");
    }
}

fn imported(file: &str) -> Result<Scenario, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/streets2/{file}"));
    load(path.to_str().expect("a path of text"), &[]).map_err(|error| format!("{:?}", error.faults()))
}

/// The ego starts on the lane for vehicles, not on the crosswalk, which is longer.
fn the_ego_starts_on_a_lane_for_vehicles() -> Result<(), String> {
    let scenario = imported("crosswalk-is-longest.xml")?;
    let network = scenario.network.as_ref().ok_or("no network")?;
    let lanes = scenario.vehicles[0].route.legs.iter().filter_map(|leg| network.lane(&leg.lane));
    hold(lanes.into_iter().all(|lane| !lane.is_path()), || format!("{:?}", scenario.vehicles[0].route.legs))
}

/// The sign R1-3 at a stop line is an all-way stop.
fn the_sign_is_an_all_way_stop() -> Result<(), String> {
    let network = imported("four-way-R1-3.xml")?.network.ok_or("no network")?;
    hold(network.lanes().iter().any(|lane| lane.right_of_way == RightOfWay::AllWayStop), || {
        "no all-way stop".to_owned()
    })
}
