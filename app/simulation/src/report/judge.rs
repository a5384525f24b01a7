//! Whether a run did what its scenario expects.

use std::collections::BTreeSet;

use interplay_scenarios::{Completes, Expect, ExpectedSpeed};
use serde_json::{Map, Value, json};

use super::driving;
use super::expectation::Expectation;
use super::judge_building::{judge_building, judge_zone};
use super::outcome::Report;

/// Judges every expectation that the scenario states.
pub(super) fn judge(expect: &Expect, report: &Report) -> Vec<Expectation> {
    let mut judged = Vec::new();
    let mut add = |what: String, want: Value, got: Value, passed: bool| {
        judged.push(Expectation::new(what, want, got, passed));
    };
    if let Some(none) = expect.no_collision {
        let count = report.collisions.len();
        add("no_collision".into(), json!(none), json!(count == 0), none == (count == 0));
    }
    if let Some(pairs) = &expect.collisions {
        let (want, got) = (unordered(pairs.iter()), unordered(report.collisions.iter().map(|one| &one.between)));
        let passed = want == got;
        add("collisions".into(), json!(want), json!(got), passed);
    }
    if let Some(order) = &expect.order {
        let got: Vec<&String> = report.order.iter().filter(|name| order.contains(name)).collect();
        let passed = got.iter().copied().eq(order);
        add("order".into(), json!(order), json!(got), passed);
    }
    if let Some(least) = expect.min_gap_m {
        let passed = report.min_gap_m.is_none_or(|gap| gap >= least);
        add("min_gap_m".into(), json!(least), json!(report.min_gap_m), passed);
    }
    if let Some(most) = expect.plan_failures_at_most {
        let failed: usize = report.vehicles.iter().map(|vehicle| vehicle.plans.failed).sum();
        add("plan_failures_at_most".into(), json!(most), json!(failed), failed <= most);
    }
    judged.extend(driving::of_all(expect, report));
    for window in &expect.completes {
        judged.push(completes(window, report));
    }
    for range in &expect.speed {
        judged.extend(speed(range, report));
    }
    judged.extend(expect.comfort.iter().flat_map(|bounds| driving::comfort(bounds, report)));
    judged.extend(expect.yields.iter().map(|expected| driving::yields(expected, report)));
    if let Some(building) = &report.building {
        let first_days = expect.building.unwrap_or_default().after_iterations;
        judged.extend(expect.building.iter().flat_map(|expect| judge_building(expect, building)));
        judged.extend(expect.zones.iter().flat_map(|expect| judge_zone(expect, first_days, building)));
    }
    judged
}

/// Each pair once, whoever is named first.
fn unordered<'a>(pairs: impl Iterator<Item = &'a [String; 2]>) -> BTreeSet<[&'a str; 2]> {
    pairs.map(|[a, b]| if a < b { [a.as_str(), b] } else { [b.as_str(), a] }).collect()
}

fn completes(window: &Completes, report: &Report) -> Expectation {
    let completed = report.vehicle(&window.vehicle).and_then(|vehicle| vehicle.completed_s);
    let (after, before) = (window.after_s.unwrap_or(0.0), window.before_s.unwrap_or(f64::INFINITY));
    Expectation {
        what: format!("completes.{}", window.vehicle),
        want: wanted_window(window),
        got: json!(completed),
        passed: completed.is_some_and(|time| (after..=before).contains(&time)),
        at: None,
    }
}

/// The limits that are stated; without one, any time will do.
fn wanted_window(window: &Completes) -> Value {
    let limits = [("after_s", window.after_s), ("before_s", window.before_s)];
    let stated: Map<String, Value> =
        limits.into_iter().filter_map(|(key, limit)| Some((key.to_owned(), json!(limit?)))).collect();
    if stated.is_empty() { json!("any time") } else { Value::Object(stated) }
}

fn speed(range: &ExpectedSpeed, report: &Report) -> Vec<Expectation> {
    let Some(vehicle) = report.vehicle(&range.vehicle) else { return Vec::new() };
    let (min, max) = (vehicle.min_speed_mps, vehicle.max_speed_mps);
    let bounds = [
        ("min_below_mps", range.min_below_mps, min, min < range.min_below_mps.unwrap_or(f64::INFINITY)),
        ("min_above_mps", range.min_above_mps, min, min > range.min_above_mps.unwrap_or(f64::NEG_INFINITY)),
        ("max_below_mps", range.max_below_mps, max, max < range.max_below_mps.unwrap_or(f64::INFINITY)),
        ("max_above_mps", range.max_above_mps, max, max > range.max_above_mps.unwrap_or(f64::NEG_INFINITY)),
    ];
    let stated =
        bounds.into_iter().filter_map(|(key, bound, got, passed)| bound.map(|bound| (key, bound, got, passed)));
    stated
        .map(|(key, bound, got, passed)| Expectation {
            what: format!("speed.{}.{key}", range.vehicle),
            want: json!(bound),
            got: json!(got),
            passed,
            at: None,
        })
        .collect()
}
