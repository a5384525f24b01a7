//! Judges whether a building fulfilled the expectations of its scenario.

use interplay_building::day::ZoneFigures;
use interplay_scenarios::{BuildingExpect, ExpectedZone};
use serde_json::{Value, json};

use super::building::BuildingReport;
use super::outcome::Expectation;
use crate::state::day::DayFigures;
use crate::state::worst_zones::WorstZones;

/// Judges the expectations of a building, by the worst of the days that count.
pub(super) fn judge_building(expect: &BuildingExpect, report: &BuildingReport) -> Vec<Expectation> {
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
        // If the value of one day is unknown, the bound does not hold.
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
    if let Some(most) = expect.total_energy_cost_at_most {
        let total: Option<f64> = days.iter().map(|day| day.figures.energy_cost).sum();
        let total = total.filter(|_| !days.is_empty());
        add("total_energy_cost_at_most", json!(most), json!(total), total.is_some_and(|total| total <= most), None);
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

/// A bounded figure of a day, given the cost of the first day, and the zone that contributes most to it.
type Bound = (&'static str, Option<f64>, fn(&DayFigures, f64) -> Option<f64>, fn(&WorstZones) -> Option<usize>);

fn upper_bounds(expect: &BuildingExpect) -> [Bound; 10] {
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
            "electricity_kwh_at_most",
            expect.electricity_kwh_at_most,
            |day, _| Some(day.figures.electricity_kwh),
            |zones| zones.electricity,
        ),
        (
            "energy_cost_at_most",
            expect.energy_cost_at_most,
            |day, _| day.figures.energy_cost,
            |zones| zones.energy_cost,
        ),
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

/// Relative excess of a day's cost over that of the centralised plan.
fn above_centralised(day: &DayFigures) -> Option<f64> {
    let exchange = day.exchange?;
    Some(exchange.cost / exchange.centralised_cost? - 1.0)
}

/// Judges the expectations of a zone, by the worst of the days after the first `first_days`.
pub(super) fn judge_zone(expect: &ExpectedZone, first_days: usize, report: &BuildingReport) -> Vec<Expectation> {
    let zone = report.zone_figures.iter().find(|zone| zone.zone == expect.zone);
    let days = zone.and_then(|zone| zone.iterations.get(first_days..)).unwrap_or_default();
    let figure = |key: &str, day: &ZoneFigures| match key {
        "tracking_rmse_c_at_most" => Some(day.tracking_rmse_c),
        "discomfort_k_h_at_most" => Some(day.discomfort_k_h),
        "energy_kwh_at_most" => Some(day.energy_kwh),
        _ => day.energy_cost,
    };
    let stated = expect.bounds().into_iter().filter_map(|(key, bound)| Some((key, bound?)));
    stated
        .map(|(key, most)| {
            let each = days.iter().zip(first_days + 1..).map(|(day, number)| Some((figure(key, day)?, number)));
            let each: Option<Vec<(f64, usize)>> = each.collect();
            let worst = each.and_then(|each| each.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)));
            Expectation {
                what: format!("zone.{}.{key}", expect.zone),
                want: json!(most),
                got: json!(worst.map(|(worst, _)| worst)),
                passed: worst.is_some_and(|(worst, _)| worst <= most),
                at: worst.filter(|(worst, _)| *worst > 0.0).map(|(_, number)| format!("day {number}")),
            }
        })
        .collect()
}
