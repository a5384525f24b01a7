//! The names under which reports list expectations, and the conflict zones that some of them judge.

use std::collections::BTreeSet;

use interplay_scenarios::MetricLimit::{AtLeast, AtMost, Is};
use interplay_scenarios::{Expect, MetricBound, from_text, load};

type Outcome = Result<(), toml::de::Error>;

/// The names of the expectations in TOML.
fn names(text: &str) -> Result<BTreeSet<String>, toml::de::Error> {
    Ok(toml::from_str::<Expect>(text)?.names())
}

#[test]
fn each_key_that_is_present_has_one_name() -> Outcome {
    let text = r#"
        no_collision = true
        rules_kept = true
        order = ["ego", "front"]
        min_gap_m = 0.1
        completes = [{ vehicle = "ego", before_s = 6.0 }, { vehicle = "front" }]
        speed = [{ vehicle = "ego", min_below_mps = 0.8, max_above_mps = 1.0 }]
        comfort = [{ vehicle = "front", braking_at_most_mps2 = 1.5 }]
        yields = [{ vehicle = "ego", to = "human" }]
        metric = [{ name = "hard_braking", vehicle = "ego", is = false }, { name = "ego_gap_m", at_least = 0.1 }]
        building = { after_iterations = 2, energy_kwh_at_most = 32.0 }
        zone = [{ zone = "office", discomfort_k_h_at_most = 1.0, energy_kwh_at_most = 3.0 }]
    "#;
    let wanted = [
        "building.energy_kwh_at_most",
        "comfort.front.braking_at_most_mps2",
        "completes.ego",
        "completes.front",
        "metric.ego_gap_m.at_least",
        "metric.hard_braking.ego.is",
        "min_gap_m",
        "no_collision",
        "order",
        "rules_kept",
        "speed.ego.max_above_mps",
        "speed.ego.min_below_mps",
        "yields.ego.to.human",
        "zone.office.discomfort_k_h_at_most",
        "zone.office.energy_kwh_at_most",
    ];
    assert_eq!(names(text)?, wanted.map(str::to_owned).into());
    Ok(())
}

#[test]
fn an_absent_key_has_no_name() -> Outcome {
    assert_eq!(names("")?, BTreeSet::new());
    assert_eq!(names("building = { after_iterations = 2 }")?, BTreeSet::new());
    Ok(())
}

#[test]
fn bounds_carry_their_own_keys() -> Outcome {
    let text = r#"
        comfort = [{ vehicle = "ego", acceleration_at_most_mps2 = 1.0, braking_at_most_mps2 = 2.0, jerk_at_most_mps3 = 3.0 }]
        metric = [{ name = "hard_braking", is = false }, { name = "off_road_m", vehicle = "ego", at_most = 0.1, at_least = 0.0 }]
        zone = [{ zone = "office", tracking_rmse_c_at_most = 1.0, energy_kwh_at_most = 3.0, energy_cost_at_most = 4.0 }]
    "#;
    let expect: Expect = toml::from_str(text)?;
    let bound = |what: &str, metric, limit| MetricBound { what: what.to_owned(), metric, vehicle: Some("ego"), limit };
    let comfort = [
        bound("comfort.ego.acceleration_at_most_mps2", "peak_acceleration_mps2", AtMost(1.0)),
        bound("comfort.ego.braking_at_most_mps2", "peak_braking_mps2", AtMost(2.0)),
        bound("comfort.ego.jerk_at_most_mps3", "peak_jerk_mps3", AtMost(3.0)),
    ];
    assert_eq!(expect.bounds_of_vehicles(), comfort);
    let metrics = [
        MetricBound { vehicle: None, ..bound("metric.hard_braking.is", "hard_braking", Is(false)) },
        bound("metric.off_road_m.ego.at_most", "off_road_m", AtMost(0.1)),
        bound("metric.off_road_m.ego.at_least", "off_road_m", AtLeast(0.0)),
    ];
    assert_eq!(expect.bounds_of_metrics(), metrics);
    let zone = [
        ("tracking_rmse_c_at_most", Some(1.0)),
        ("discomfort_k_h_at_most", None),
        ("energy_kwh_at_most", Some(3.0)),
        ("energy_cost_at_most", Some(4.0)),
    ];
    assert_eq!(expect.zones[0].bounds(), zone);
    Ok(())
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
fn zones_of_an_intersection_are_those_of_its_roads() {
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
