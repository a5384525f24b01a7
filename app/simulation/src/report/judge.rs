//! Whether a run did what its scenario expects.

use std::collections::BTreeSet;

use interplay_scenarios::{BuildingExpect, Completes, Expect, ExpectedSpeed};
use serde_json::{Value, json};

use super::building::BuildingReport;
use super::driving;
use super::expectation::Expectation;
use super::outcome::Report;
use crate::day::DayFigures;
use crate::worst_zones::WorstZones;

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
    if let (Some(expect), Some(building)) = (&expect.building, &report.building) {
        judged.extend(judge_building(expect, building));
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
        want: json!({ "after_s": window.after_s, "before_s": window.before_s }),
        got: json!(completed),
        passed: completed.is_some_and(|time| (after..=before).contains(&time)),
        at: None,
    }
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

/// Judges what is expected of a building; the worst of the days that count.
fn judge_building(expect: &BuildingExpect, report: &BuildingReport) -> Vec<Expectation> {
    let days = report.iterations.get(expect.after_iterations..).unwrap_or_default();
    let numbered = || days.iter().zip(expect.after_iterations + 1..);
    let mut judged = Vec::new();
    let mut add = |what: &str, want: Value, got: Value, passed: bool, at: Option<String>| {
        judged.push(Expectation { what: format!("building.{what}"), want, got, passed, at });
    };
    if let Some(want) = expect.cost_never_rises {
        let falls = days.windows(2).all(|pair| pair[1].figures.cost <= pair[0].figures.cost);
        add("cost_never_rises", json!(want), json!(falls), want == falls, None);
    }
    let first = report.iterations.first().map_or(f64::NAN, |day| day.figures.cost);
    for (what, most, figure, zone) in upper_bounds(expect) {
        let Some(most) = most else { continue };
        // What is not known on one of the days is not known to be within the bound.
        let each: Option<Vec<_>> = numbered().map(|(day, number)| Some((figure(day, first)?, number, day))).collect();
        let worst = each.and_then(|each| each.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)));
        let at = worst.filter(|(worst, ..)| *worst > 0.0).map(|(_, number, day)| {
            let zone = zone(&day.worst_zones).and_then(|zone| report.zone_names.get(zone));
            zone.map_or_else(|| format!("day {number}"), |zone| format!("day {number}, most in {zone}"))
        });
        let worst = worst.map(|(worst, ..)| worst);
        add(what, json!(most), json!(worst), worst.is_some_and(|worst| worst <= most), at);
    }
    if let Some(least) = expect.early_kwh_at_least {
        let worst = numbered().map(|(day, number)| (day.early_kwh, number)).min_by(|a, b| a.0.total_cmp(&b.0));
        let passed = worst.is_some_and(|(worst, _)| worst >= least);
        let at = worst.map(|(_, number)| format!("day {number}"));
        add("early_kwh_at_least", json!(least), json!(worst.map(|(worst, _)| worst)), passed, at);
    }
    if let Some(most) = expect.fallbacks_at_most {
        let count = days.iter().filter(|day| day.fallback).count();
        add("fallbacks_at_most", json!(most), json!(count), count <= most, None);
    }
    if let Some(want) = expect.exchange_never_rises {
        let falls =
            !days.is_empty() && days.iter().all(|day| day.exchange.is_some_and(|exchange| exchange.never_rises));
        add("exchange_never_rises", json!(want), json!(falls), want == falls, None);
    }
    judged
}

/// A figure of a day that has an upper bound, given the cost of the first day, and the zone that does most for it.
type Bound = (&'static str, Option<f64>, fn(&DayFigures, f64) -> Option<f64>, fn(&WorstZones) -> Option<usize>);

fn upper_bounds(expect: &BuildingExpect) -> [Bound; 8] {
    let none = |_: &WorstZones| None;
    [
        (
            "cost_at_most_share_of_first",
            expect.cost_at_most_share_of_first,
            |day, first| Some(day.figures.cost / first),
            none,
        ),
        (
            "tracking_rmse_c_at_most",
            expect.tracking_rmse_c_at_most,
            |day, _| Some(day.figures.tracking_rmse_c),
            |zones| zones.tracking,
        ),
        (
            "discomfort_k_h_at_most",
            expect.discomfort_k_h_at_most,
            |day, _| Some(day.figures.discomfort_k_h),
            |zones| zones.discomfort,
        ),
        ("energy_kwh_at_most", expect.energy_kwh_at_most, |day, _| Some(day.figures.energy_kwh), |zones| zones.energy),
        (
            "input_violation_kw_at_most",
            expect.input_violation_kw_at_most,
            |day, _| Some(day.figures.input_violation_kw),
            |zones| zones.input_violation,
        ),
        ("regret_at_most", expect.regret_at_most, |day, _| day.regret, none),
        ("spectral_radius_at_most", expect.spectral_radius_at_most, |day, _| day.spectral_radius, none),
        ("above_centralised_at_most", expect.above_centralised_at_most, |day, _| above_centralised(day), none),
    ]
}

/// By how much the plan of a day is dearer than the centralised one, as a share.
fn above_centralised(day: &DayFigures) -> Option<f64> {
    let exchange = day.exchange?;
    Some(exchange.cost / exchange.centralised_cost? - 1.0)
}
