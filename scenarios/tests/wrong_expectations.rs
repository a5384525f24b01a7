//! Expectations that cannot hold, cannot fail, or are about no vehicle.

mod common;
mod spoiled;

use common::Catalogue;
use interplay_scenarios::{from_text, load};
use spoiled::{GOOD, refusal, spoiled};

/// The good scenario with further expectations.
fn with(expectations: &str) -> String {
    format!("{GOOD}\n{expectations}")
}

#[test]
fn expectations_that_can_never_fail_are_refused() {
    let mut errors = Catalogue::default();
    let order = |text: &'static str| [("order = [\"front\", \"ego\"]", text)];
    let remedy = "order = [\"ego\", \"front\"]";
    refusal(&mut errors, "order_of_no_vehicle", &order("order = []"), &["bad.toml:23:9", "names no vehicle", remedy]);
    refusal(&mut errors, "one_only", &order("order = [\"ego\"]"), &["names `ego` only", remedy]);
    let collisions = [("no_collision = true", "collisions = []")];
    refusal(&mut errors, "no_pair", &collisions, &["bad.toml:22:14", "names no vehicle", "`no_collision = true`"]);
    insta::assert_snapshot!("an_order_that_can_never_fail", errors.0);
}

#[test]
fn wrong_comfort_and_limit_expectations_are_refused() {
    let mut errors = Catalogue::default();
    let mut refuse = |name: &str, text: &str, fragments: &[&str]| {
        errors.error(name, from_text("bad.toml", &with(text), &[]), fragments);
    };
    refuse(
        "unknown_vehicle",
        "[[expect.comfort]]\nvehicle = 'fornt'\njerk_at_most_mps3 = 1",
        &["bad.toml:30:11", "did you mean `front`?"],
    );
    refuse("no_bound", "[[expect.comfort]]\nvehicle = 'ego'", &["expects nothing", "`jerk_at_most_mps3`"]);
    refuse(
        "negative_bound",
        "[[expect.comfort]]\nvehicle = 'ego'\nbraking_at_most_mps2 = -1",
        &["bad.toml:31:24", "at least 0"],
    );
    let mut change = |name: &str, text: &str, fragments: &[&str]| {
        let changed = spoiled(&[("no_collision = true", text)]);
        errors.error(name, from_text("bad.toml", &changed, &[]), fragments);
    };
    change("no_speed_limit", "speed_limit_exceeded_by_at_most_mps = 0.5", &["bad.toml:22:", "`max_below_mps`"]);
    change("no_vehicle_keeps_rules", "rules_kept = true", &["bad.toml:22:", "no vehicle keeps", "rules = \"kept\""]);
    change("long_time", "time_to_collision_at_least_s = 101", &["at most 100"]);
    change("negative_gap", "gap_at_least_m = -0.1", &["at least 0"]);
    insta::assert_snapshot!("comfort_and_limits", errors.0);
}

#[test]
fn vehicles_that_never_meet_cannot_give_way() {
    let mut errors = Catalogue::default();
    let mut refuse = |name: &str, [vehicle, to]: [&str; 2], fragments: &[&str]| {
        let text = with(&format!("[[expect.yields]]\nvehicle = '{vehicle}'\nto = '{to}'"));
        errors.error(name, from_text("bad.toml", &text, &[]), fragments);
    };
    refuse(
        "on_one_road",
        ["ego", "front"],
        &["bad.toml:29:1", "never cross or merge", "`order` judges vehicles on one"],
    );
    refuse("unknown", ["ego", "fornt"], &["bad.toml:31:6", "did you mean `front`?"]);
    refuse("to_itself", ["ego", "ego"], &["bad.toml:31:6", "named twice"]);
    let crossing = "extends = 'intersection/stop-sign'\ntitle = 'a'\nshows = 'b'\n[[expect.yields]]\n";
    let pair =
        |vehicle: &str, to: &str| from_text("bad.toml", &format!("{crossing}vehicle = '{vehicle}'\nto = '{to}'"), &[]);
    pair("ego", "first").expect("their roads cross");
    errors.error("both_on_the_crossing_road", pair("second", "first"), &["`order` judges vehicles on one road"]);
    insta::assert_snapshot!("vehicles_that_never_meet_cannot_give_way", errors.0);
}

#[test]
fn every_expectation_has_a_name() {
    let text = "extends = 'intersection/nice'\ntitle = 'a'\nshows = 'b'\n[expect]\noff_road_at_most_m = 0.0\n\
                gap_at_least_m = 0.1\ntime_to_collision_at_least_s = 0.5\n\
                comfort = [{ vehicle = 'ego', jerk_at_most_mps3 = 9, braking_at_most_mps2 = 1 }]\n\
                yields = [{ vehicle = 'crossing', to = 'ego' }]";
    let names = from_text("mine.toml", text, &[]).expect("sound").expect.names();
    for name in [
        "off_road_at_most_m",
        "gap_at_least_m",
        "time_to_collision_at_least_s",
        "comfort.ego.jerk_at_most_mps3",
        "comfort.ego.braking_at_most_mps2",
        "yields.crossing.to.ego",
    ] {
        assert!(names.contains(name), "{name} is not in {names:?}");
    }
    assert!(!names.iter().any(|name| name.ends_with(".vehicle") || name.contains("lateral")), "{names:?}");
}

/// The conflict zones of an intersection are the overlap of its roads, in either order of the vehicles.
#[test]
fn conflict_zones_of_an_intersection_are_where_its_roads_overlap() {
    let scenario = load("intersection/stop-sign", &[]).expect("authored");
    let vehicle = |name: &str| scenario.vehicle(name).expect("authored");
    let zones = scenario.road.conflict_zones(vehicle("ego"), vehicle("first"));
    let [zone] = zones.as_slice() else { panic!("{zones:?}") };
    let (near, far) = (0.0, 0.37);
    let is = |zone: [f64; 2], wanted: [f64; 2]| zone.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(is(zone.first_m, [-0.5 * far, 0.5 * far]) && is(zone.second_m, [near, far]), "{zone:?}");
    let turned = scenario.road.conflict_zones(vehicle("first"), vehicle("ego"));
    assert_eq!((turned[0].first_m, turned[0].second_m), (zone.second_m, zone.first_m));
    assert!(scenario.road.conflict_zones(vehicle("first"), vehicle("second")).is_empty());
}
