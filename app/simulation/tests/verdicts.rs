//! Expectations hold up to their bound and not beyond it, and report the value by which they were judged.

use interplay_building::day::ZoneFigures;
use interplay_scenarios::{Override, Scenario, from_text, load};
use interplay_simulation::report::{Expectation, Report};
use interplay_simulation::run::run;
use serde_json::json;

fn report(name: &str, changes: &[String]) -> Report {
    let changes: Vec<Override> = changes.iter().map(|change| Override::Set(change.clone())).collect();
    let scenario = load(name, &changes).unwrap_or_else(|error| panic!("{changes:?}: {error:?}"));
    run(name, &scenario, Vec::new()).expect("it runs")
}

/// The named expectation in a run with changes.
fn judged(name: &str, changes: &[String], what: &str) -> Expectation {
    let found = report(name, changes).expectations.into_iter().find(|expectation| expectation.what == what);
    found.unwrap_or_else(|| panic!("{name}: {what} is not judged"))
}

/// A bound holds at the measured value, but not slightly beyond, on the side where it is stricter (`sign`).
fn holds_up_to(name: &str, changes: &[String], path: &str, what: &str, got: f64, sign: f64) {
    let bounded = |bound: f64| {
        let changes = [changes, &[format!("{path}={bound:?}")]].concat();
        judged(name, &changes, what)
    };
    let at = bounded(got);
    assert!(at.passed && at.want.as_f64() == Some(got) && at.got.as_f64() == Some(got), "{what}: {at:?}");
    let beyond = bounded(got + sign * (1e-9 + 1e-6 * got.abs()));
    assert!(!beyond.passed && beyond.got.as_f64() == Some(got), "{what}: {beyond:?}");
    let within = bounded(got - sign * (1e-9 + 1e-6 * got.abs()));
    assert!(within.passed, "{what}: {within:?}");
}

const DRIVE: &str = "intersection/nice";

#[test]
fn bounds_on_a_drive_hold_exactly_up_to_the_measured_value() {
    let plain = report(DRIVE, &[]);
    let ego = plain.vehicle("ego").expect("an ego");
    let gap_m = plain.min_gap_m().expect("two vehicles");
    holds_up_to(DRIVE, &[], "expect.min_gap_m", "min_gap_m", gap_m, 1.0);
    let [slowest, fastest] = ego.speed_range_mps();
    assert!(slowest < fastest);
    for (key, measured) in [("min", slowest), ("max", fastest)] {
        for (side, sign) in [("above", 1.0), ("below", -1.0)] {
            let what = format!("speed.ego.{key}_{side}_mps");
            let verdict = |bound: f64| {
                let change = format!("expect.speed=[{{ vehicle = 'ego', {key}_{side}_mps = {bound:?} }}]");
                judged(DRIVE, &[change], &what).passed
            };
            let passed = [-1e-6, 0.0, 1e-6].map(|by| verdict(measured + sign * by));
            assert_eq!(passed, [true, false, false], "{what} is strict");
        }
    }
    let at_s = ego.completed_s.expect("it arrives");
    for (window, passed) in [
        (format!("after_s = {at_s:?}, before_s = {:?}", at_s + 0.01), true),
        (format!("after_s = {:?}, before_s = {at_s:?}", at_s - 0.01), true),
        (format!("after_s = {:?}", at_s + 0.01), false),
        (format!("before_s = {:?}", at_s - 0.01), false),
        (String::new(), true),
    ] {
        let comma = if window.is_empty() { "" } else { ", " };
        let found =
            judged(DRIVE, &[format!("expect.completes=[{{ vehicle = 'ego'{comma}{window} }}]")], "completes.ego");
        assert_eq!((found.passed, found.got.as_f64()), (passed, Some(at_s)), "{window}");
        assert_eq!(found.want.is_string(), window.is_empty(), "{found:?}");
    }
}

#[test]
fn expectations_on_passing_orders_and_contacts_are_judged() {
    let verdict = |name: &str, change: &str, what: &str| judged(name, &[change.to_owned()], what).passed;
    let order = report(DRIVE, &[]).order;
    let reversed: Vec<&String> = order.iter().rev().collect();
    assert!(verdict(DRIVE, &format!("expect.order={order:?}"), "order"));
    assert!(!verdict(DRIVE, &format!("expect.order={reversed:?}"), "order"));
    assert!(verdict(DRIVE, "expect.no_collision=true", "no_collision"));
    assert!(!verdict(DRIVE, "expect.collisions=[['ego', 'crossing']]", "collisions"), "no vehicle touches another");
    assert!(verdict(DRIVE, "expect.plan_failures_at_most=0", "plan_failures_at_most"));
    let crash = "crash/side-impact";
    let contacts = report(crash, &[]).collisions;
    let [a, b] = &contacts.first().expect("a contact").between;
    assert!(verdict(crash, &format!("expect.collisions=[['{a}', '{b}']]"), "collisions"));
    assert!(verdict(crash, &format!("expect.collisions=[['{b}', '{a}']]"), "collisions"), "in either order of names");
    assert!(verdict(crash, "expect.no_collision=false", "no_collision"));
    let failed = judged(crash, &["expect.no_collision=true".to_owned()], "no_collision");
    let at = failed.at.as_deref().unwrap_or_default();
    assert!(!failed.passed && at.starts_with("crossing drove into ego at 1.57 s"), "{failed:?}");
    assert!(!verdict(DRIVE, "expect.no_collision=false", "no_collision"));
}

/// A street with a stop sign, 10 m ahead of the ego's start; a vehicle that breaks no rule drives ahead of it.
fn stop_street(speed_mps: f64, rules: &str) -> Scenario {
    let text = format!(
        "title = 'a'\nshows = 'b'\nduration_s = 6.0\nconduct = 'people'\n\
         [road]\nkind = 'network'\n\
         [[road.lane]]\nname = 'in'\npoints = [[-60.0, 0.0], [0.0, 0.0]]\nwidth_m = 3.5\nsuccessors = ['out']\n\
         right_of_way = 'stop'\n\
         [[road.lane]]\nname = 'out'\npoints = [[0.0, 0.0], [150.0, 0.0]]\nwidth_m = 3.5\n\
         [[vehicle]]\nname = 'ego'\nclass = 'car'\nstart = {{ lane = 'in', along_m = 50.0, speed_mps = {speed_mps:?} }}\n\
         goal = {{ lane = 'out', speed_mps = 12.0 }}\ndriver = {{ kind = 'human' }}\nrules = '{rules}'\n\
         [[vehicle]]\nname = 'ahead'\nclass = 'car'\nstart = {{ lane = 'out', along_m = 90.0, speed_mps = 10.0 }}\n\
         driver = {{ kind = 'human' }}\n[expect]\nrules_kept = true\n"
    );
    from_text("street.toml", &text, &[]).unwrap_or_else(|error| panic!("{:?}", error.faults()))
}

#[test]
fn only_rule_keeping_vehicles_are_judged_by_rules() {
    let verdict = |speed_mps: f64, rules: &str| {
        let scenario = stop_street(speed_mps, rules);
        let report = run("street", &scenario, Vec::new()).expect("it runs");
        let broken = report.vehicle("ego").and_then(|ego| ego.metrics.number("rules_broken"));
        let [judged] = report.expectations.as_slice() else { panic!("{:?}", report.expectations) };
        assert_eq!(judged.what, "rules_kept");
        (judged.passed, broken, judged.got.clone())
    };
    assert_eq!(verdict(1.0, "kept"), (true, Some(0.0), json!(true)), "it stops");
    let (passed, broken, got) = verdict(15.0, "kept");
    assert!(!passed && broken >= Some(1.0), "it cannot stop");
    assert_eq!(got["rules_broken"]["ego"].as_f64(), broken);
    let (passed, broken, _) = verdict(15.0, "ignored");
    assert!(passed && broken >= Some(1.0), "a vehicle that ignores the rules is not judged by them");
}

const BUILDING: &str = "building/distributed";

/// The worst of the days that count is judged.
#[test]
fn bounds_on_a_building_hold_exactly_up_to_its_worst_day() {
    let changes = ["iterations=3".to_owned(), "expect.building.after_iterations=1".to_owned()];
    let plain = report(BUILDING, &changes).building.expect("a building");
    let days = &plain.iterations[1..];
    let worst = |of: &dyn Fn(usize) -> f64| (0..days.len()).map(of).fold(f64::NEG_INFINITY, f64::max);
    let first_cost = plain.iterations[0].figures.cost;
    let centralised = |day: usize| {
        let exchange = days[day].exchange.expect("zones exchange messages");
        exchange.cost / exchange.centralised_cost.expect("compared") - 1.0
    };
    let bounds: [(&str, f64); 6] = [
        ("cost_at_most_share_of_first", worst(&|day| days[day].figures.cost / first_cost)),
        ("tracking_rmse_c_at_most", worst(&|day| days[day].figures.tracking_rmse_c)),
        ("discomfort_k_h_at_most", worst(&|day| days[day].figures.discomfort_k_h)),
        ("energy_kwh_at_most", worst(&|day| days[day].figures.energy_kwh)),
        ("regret_at_most", worst(&|day| days[day].regret.expect("a small building"))),
        ("above_centralised_at_most", worst(&centralised)),
    ];
    for (key, got) in bounds.into_iter().filter(|(_, got)| *got >= 0.0) {
        let what = format!("building.{key}");
        holds_up_to(BUILDING, &changes, &format!("expect.building.{key}"), &what, got, -1.0);
    }
    let least = days.iter().map(|day| day.early_kwh).fold(f64::INFINITY, f64::min);
    let (path, what) = ("expect.building.early_kwh_at_least", "building.early_kwh_at_least");
    holds_up_to(BUILDING, &changes, path, what, least, 1.0);
    let verdict = |change: &str, what: &str| judged(BUILDING, &[&changes[..], &[change.to_owned()]].concat(), what);
    for (key, truth) in
        [("cost_never_rises", days[1].figures.cost <= days[0].figures.cost), ("exchange_never_rises", true)]
    {
        for want in [true, false] {
            let found = verdict(&format!("expect.building.{key}={want}"), &format!("building.{key}"));
            assert_eq!((found.passed, found.got.as_bool()), (want == truth, Some(truth)), "{key}");
        }
    }
    assert!(verdict("expect.building.fallbacks_at_most=0", "building.fallbacks_at_most").passed);
    let tracking = verdict("expect.building.tracking_rmse_c_at_most=9.0", "building.tracking_rmse_c_at_most");
    let number = 2 + usize::from(days[1].figures.tracking_rmse_c >= days[0].figures.tracking_rmse_c);
    let at = tracking.at.expect("the worst day is named");
    assert!(at.starts_with(&format!("day {number}, most in ")), "{at}");
}

/// A zone is judged by its own figures, on the days that count.
#[test]
fn bounds_on_a_zone_hold_exactly_up_to_its_worst_day() {
    let changes = ["iterations=3".to_owned(), "expect.building.after_iterations=1".to_owned()];
    let plain = report(BUILDING, &changes).building.expect("a building");
    let zone = &plain.zone_figures[1];
    let days = &zone.iterations[1..];
    type Figure = (&'static str, fn(&ZoneFigures) -> f64);
    let figures: [Figure; 3] = [
        ("tracking_rmse_c_at_most", |day| day.tracking_rmse_c),
        ("discomfort_k_h_at_most", |day| day.discomfort_k_h),
        ("energy_kwh_at_most", |day| day.energy_kwh),
    ];
    for (key, of) in figures {
        let (day, worst) =
            days.iter().map(of).enumerate().fold((0, 0.0), |worst, now| if now.1 >= worst.1 { now } else { worst });
        let what = format!("zone.{}.{key}", zone.zone);
        let bounded = |most: f64| {
            let expected = format!("expect.zone=[{{ zone = '{}', {key} = {most:?} }}]", zone.zone);
            judged(BUILDING, &[&changes[..], &[expected]].concat(), &what)
        };
        let at = bounded(worst);
        assert!(at.passed && at.got.as_f64() == Some(worst), "{at:?}");
        let named = (worst > 0.0).then(|| format!("day {}", day + 2));
        assert_eq!(at.at, named, "{key}");
        assert_eq!(bounded((worst - 1e-6).max(0.0)).passed, worst == 0.0, "{key}");
    }
}
