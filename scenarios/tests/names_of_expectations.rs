//! The names under which reports list expectations.

use std::collections::BTreeSet;

use interplay_scenarios::MetricLimit::{AtLeast, AtMost, Is};
use interplay_scenarios::{Expect, MetricBound};

type Outcome = Result<(), toml::de::Error>;

/// The names of the expectations in TOML.
fn names(text: &str) -> Result<BTreeSet<String>, toml::de::Error> {
    Ok(toml::from_str::<Expect>(text)?.names())
}

#[test]
fn each_present_expectation_key_has_one_name() -> Outcome {
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
fn an_absent_expectation_key_has_no_name() -> Outcome {
    assert_eq!(names("")?, BTreeSet::new());
    assert_eq!(names("building = { after_iterations = 2 }")?, BTreeSet::new());
    Ok(())
}

#[test]
fn names_of_bounds_include_their_keys() -> Outcome {
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
