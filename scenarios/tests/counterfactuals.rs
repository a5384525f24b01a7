//! Counterfactuals in a file: what they change and what they inherit; and the names of expectations. `refusals.rs` has their errors.

mod common;

use std::collections::BTreeSet;

use interplay_planners::Driver;
use interplay_planners::drivers::human::Style;
use interplay_scenarios::MetricLimit::{AtLeast, AtMost, Is};
use interplay_scenarios::{Expect, MetricBound, Override, Registry, Scenario, embedded, from_text, load};

/// A variant with one counterfactual, whose table is `stated`.
fn variant(stated: &str) -> String {
    format!(
        "extends = 'intersection/tough'\ntitle = 'Mine'\n\n[[counterfactual]]\nname = 'what if'\n{stated}\n\
         [counterfactual.expect]\norder_differs = true\n"
    )
}

fn loaded(text: &str, overrides: &[Override]) -> Scenario {
    from_text("mine.toml", text, overrides).unwrap_or_else(|error| panic!("{:?}", error.faults()))
}

/// The scenario that the only counterfactual runs.
fn changed(stated: &str, overrides: &[Override]) -> Scenario {
    let scenario = loaded(&variant(stated), overrides);
    let changed = &scenario.counterfactuals.first().expect("one counterfactual").scenario;
    changed.clone()
}

fn set(assignment: &str) -> Override {
    Override::Set(assignment.to_owned())
}

fn style(scenario: &Scenario) -> Option<Style> {
    match &scenario.vehicle("crossing").expect("there").driver {
        Driver::Human(human) => human.style,
        other => panic!("{other:?} is not human"),
    }
}

/// A path in any spelling changes what `--set` would change.
#[test]
fn a_counterfactual_is_the_scenario_that_flags_would_make() {
    let flags = [set("vehicle.crossing.driver.style=\"nice\""), set("vehicle.crossing.goal.speed_mps=0.7")];
    let expected = load("intersection/tough", &flags).expect("authored");
    for spelling in [
        "set = { 'vehicle.crossing.driver.style' = 'nice', 'vehicle.crossing.goal.speed_mps' = 0.7 }",
        "set = { vehicle.crossing.driver.style = 'nice', vehicle.crossing.goal.speed_mps = 0.7 }",
        "set = { vehicle.crossing = { driver.style = 'nice', 'goal.speed_mps' = 0.7 } }",
        "[counterfactual.set]\nvehicle.crossing.driver.style = 'nice'\nvehicle.crossing.goal.speed_mps = 0.7",
        "[counterfactual.set.vehicle.crossing]\ndriver = { style = 'nice' }\ngoal = { speed_mps = 0.7 }",
    ] {
        let found = changed(spelling, &[]);
        assert_eq!(found.vehicles, expected.vehicles, "{spelling}");
        assert_eq!((found.road, found.seed), (expected.road.clone(), expected.seed), "{spelling}");
        assert_eq!(found.expect, Default::default(), "it has none of the scenario's expectations: {spelling}");
    }
}

#[test]
fn a_counterfactual_changes_the_planner_before_its_settings() {
    let found = changed("planner = 'negotiation'\nset = { vehicle.ego.driver.persuasion = false }", &[]);
    let Some(Driver::Negotiation(settings)) = found.ego().map(|ego| &ego.driver) else { panic!("not negotiation") };
    assert!(!settings.persuasion && settings.safety_filter);
    let found = changed("planner = 'idm'", &[]);
    assert!(matches!(found.ego().expect("there").driver, Driver::Idm(_)));
}

/// Changes by flags apply to the counterfactual too, unless it states another value.
#[test]
fn flags_also_change_counterfactuals_whose_own_changes_win() {
    let flags = [Override::Seed(9), set("duration_s=5"), set("vehicle.crossing.driver.style=\"nice\"")];
    let found = changed("set = { duration_s = 2.0 }", &flags);
    assert_eq!((found.seed, found.duration_s, style(&found)), (9, 2.0, Some(Style::Nice)));
    let kept = loaded(&variant("planner = 'idm'"), &[Override::Planner("conservative".to_owned())]);
    let kinds: Vec<&str> =
        [&kept, &kept.counterfactuals[0].scenario].map(|scenario| scenario.vehicles[0].driver.kind()).into();
    assert_eq!(kinds, ["conservative", "idm"]);
    assert!(loaded(&variant("planner = 'idm'"), &[set("counterfactual=[]")]).counterfactuals.is_empty());
}

/// A counterfactual of a mechanism that the planner of a flag does not have is not an error of the file.
#[test]
fn a_counterfactual_that_flags_make_invalid_is_left_out() {
    let text = variant("set = { vehicle.ego.driver.persuasion = false }");
    assert_eq!(loaded(&text, &[]).counterfactuals.len(), 1);
    let scenario = loaded(&text, &[Override::Planner("idm".to_owned())]);
    assert_eq!(scenario.counterfactuals, []);
    let [[name, reason]] = scenario.left_out.as_slice() else { panic!("{:?}", scenario.left_out) };
    assert_eq!((name.as_str(), reason.as_str()), ("what if", "unknown key `persuasion` in `vehicle.ego.driver`"));
    let broken = text.replace("persuasion", "persuation");
    from_text("mine.toml", &broken, &[Override::Planner("idm".to_owned())]).expect_err("wrong with and without flags");
}

#[test]
fn a_variant_has_its_own_counterfactuals_only() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let base = folder.path().join("base.toml");
    std::fs::write(&base, variant("planner = 'idm'")).expect("a writable folder");
    assert_eq!(load(&base.to_string_lossy(), &[]).expect("sound").counterfactuals.len(), 1);
    let more = format!("extends = '{}'\ntitle = 'A variant'", base.to_string_lossy());
    let scenario = loaded(&more, &[]);
    assert_eq!(scenario.counterfactuals, []);
}

/// A written counterfactual reads back, and `interplay new` keeps it.
#[test]
fn a_counterfactual_is_written_and_read_back() {
    let scenario = loaded(&variant("set = { 'vehicle.crossing.driver.style' = 'nice', vehicle.ego.limits = {} }"), &[]);
    assert_eq!(loaded(&scenario.to_file().to_toml(), &[]), scenario);
}

/// A building has no order and no planner.
#[test]
fn a_building_may_have_counterfactuals() {
    let stated = |more: &str| {
        let text = "extends = 'building/four-room-pid'\ntitle = 'Mine'\niterations = 2\n[[counterfactual]]\nname = 'what if'\n";
        from_text("mine.toml", &format!("{text}{more}"), &[])
    };
    let sound = stated("set = { 'controller.kind' = 'thermostat' }\nexpect = { building.cost_never_rises = true }");
    let sound = sound.unwrap_or_else(|error| panic!("{:?}", error.faults()));
    let changed = &sound.counterfactuals[0].scenario;
    assert_eq!((changed.controller().kind(), changed.days()), ("thermostat", 2));
    let order = "set = { 'controller.kind' = 'thermostat' }\nexpect.order_differs = true";
    common::refused(stated(order), &["mine.toml:7:", "there are no vehicles"]);
    common::refused(stated("planner = 'idm'\nexpect.order_differs = true"), &["there are no vehicles"]);
}

/// Settings that a file states for its planner are varied, and no others.
#[test]
fn why_varies_the_planner_settings_that_a_file_states() {
    let factors = |sets: &[&str]| -> Vec<(String, String)> {
        let sets: Vec<Override> = sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
        let scenario = load("intersection/nice", &sets).expect("sound");
        let changes = Registry::standard().standard_changes("intersection/nice", &scenario, &sets).expect("they fit");
        changes.into_iter().map(|one| (one.factor, one.change)).collect()
    };
    let plain = factors(&[]);
    let is_of = |key: &'static str| move |(factor, _): &&(String, String)| *factor == format!("ego's {key}");
    for key in ["settled_steps", "patience_steps"] {
        assert!(plain.iter().find(is_of(key)).is_none(), "{key} is not named: {plain:?}");
    }
    let named = factors(&["vehicle.ego.driver.settled_steps=29", "vehicle.ego.driver.patience_steps=40"]);
    let what = |key| named.iter().find(is_of(key)).map(|(_, change)| change.as_str());
    assert_eq!(what("settled_steps"), Some("ego: settled_steps = 6"));
    assert_eq!(what("patience_steps"), Some("ego: patience_steps = 5"));
    // A mechanism is switched off where it is on, and on where the file switches it off.
    let persuasion = |all: &[(String, String)]| all.iter().find(is_of("persuasion")).map(|(_, change)| change.clone());
    assert_eq!(persuasion(&plain).as_deref(), Some("ego: without persuasion (persuasion = false)"));
    let off = factors(&["vehicle.ego.driver.persuasion=false"]);
    assert_eq!(persuasion(&off).as_deref(), Some("ego: with persuasion (persuasion = true)"));
    let planners: Vec<_> = plain.iter().filter(is_of("planner")).collect();
    assert!(planners.iter().all(|(_, change)| !change.ends_with("idm")), "{planners:?}");
    assert!(plain.iter().any(|(factor, _)| factor == "ego's replacement by IDM"));
}

/// Each change of the standard list is a scenario that differs from its origin in this one thing.
#[test]
fn the_standard_changes_of_why_fit_every_authored_scenario() {
    for file in embedded() {
        let scenario = load(file.name, &[]).expect("authored");
        let changes = Registry::standard().standard_changes(file.name, &scenario, &[]);
        let changes = changes.unwrap_or_else(|error| panic!("{}: {:?}", file.name, error.faults()));
        assert_eq!(changes.is_empty(), scenario.vehicles.is_empty(), "{}", file.name);
        for one in changes {
            let pairs = one.scenario.vehicles.iter().zip(&scenario.vehicles);
            assert_eq!(pairs.filter(|(a, b)| a != b).count(), 1, "{}: {}", file.name, one.change);
            assert_eq!(one.scenario.expect, scenario.expect, "{}: {}", file.name, one.change);
            assert!(one.scenario.counterfactuals.is_empty() && !one.factor.is_empty(), "{}: {}", file.name, one.change);
        }
    }
}

#[test]
fn why_varies_a_driver_that_the_file_does_not_state() {
    let text = "title = 'a'\nshows = 'b'\nscale = 'full'\n[[vehicle]]\nname = 'car'\nstart = { lane = 0, along_m = 1.0, speed_mps = 3.0 }\n";
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("mine.toml").to_string_lossy().into_owned();
    std::fs::write(&path, text).expect("a writable folder");
    let scenario = load(&path, &[]).expect("a human by default");
    let changes = Registry::standard().standard_changes(&path, &scenario, &[]).expect("they fit");
    let style = changes.iter().find(|one| one.factor == "car's style").expect("a style");
    assert_eq!(style.sets, ["vehicle.car.driver.kind=\"human\"", "vehicle.car.driver.style=\"tough\""]);
    assert!(changes.iter().any(|one| one.factor == "car's late reaction"));
    assert!(changes.iter().all(|one| one.scenario.vehicles[0] != scenario.vehicles[0]));
}

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
