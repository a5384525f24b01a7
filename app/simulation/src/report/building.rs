//! The outcome for a building.

use interplay_scenarios::{BuildingExpect, Scenario};
use serde::Serialize;
use serde_json::{Value, json};

use super::Expectation;
use crate::day::DayFigures;
use crate::measure::{BuildingDigests, BuildingMeasures, Fallback};

/// The outcome for a building.
#[derive(Clone, Debug, Serialize)]
pub struct BuildingReport {
    /// The word for its controller.
    pub controller: String,
    /// How many zones there are.
    pub zones: usize,
    /// Digests of what each part of the climate produced.
    pub digests: BuildingDigests,
    /// What is allowed and may not have been meant, such as zones that exchange heat with nobody.
    pub remarks: Vec<String>,
    /// The days on which the controller had no plan of its own, and why.
    pub fallbacks: Vec<Fallback>,
    /// Every day.
    pub iterations: Vec<DayFigures>,
}

impl BuildingReport {
    /// Puts the measures together.
    pub fn new(scenario: &Scenario, measures: &BuildingMeasures) -> Self {
        BuildingReport {
            controller: scenario.controller().kind().to_owned(),
            zones: measures.zones,
            digests: measures.digests(),
            remarks: measures.remarks.clone(),
            fallbacks: measures.fallbacks.clone(),
            iterations: measures.days.clone(),
        }
    }
}

/// Judges what is expected of a building; the worst of the days that count.
pub(super) fn judge(expect: &BuildingExpect, report: &BuildingReport) -> Vec<Expectation> {
    let days = report.iterations.get(expect.after_iterations..).unwrap_or_default();
    let mut judged = Vec::new();
    let mut add = |what: &str, want: Value, got: Value, passed: bool| {
        judged.push(Expectation { what: format!("building.{what}"), want, got, passed });
    };
    if let Some(want) = expect.cost_never_rises {
        let falls = days.windows(2).all(|pair| pair[1].figures.cost <= pair[0].figures.cost);
        add("cost_never_rises", json!(want), json!(falls), want == falls);
    }
    let first = report.iterations.first().map_or(f64::NAN, |day| day.figures.cost);
    for (what, most, figure) in upper_bounds(expect) {
        let Some(most) = most else { continue };
        // What is not known on one of the days is not known to be within the bound.
        let each: Option<Vec<f64>> = days.iter().map(|day| figure(day, first)).collect();
        let worst = each.and_then(|each| each.into_iter().max_by(f64::total_cmp));
        add(what, json!(most), json!(worst), worst.is_some_and(|worst| worst <= most));
    }
    if let Some(least) = expect.early_kwh_at_least {
        let worst = days.iter().map(|day| day.early_kwh).min_by(f64::total_cmp);
        add("early_kwh_at_least", json!(least), json!(worst), worst.is_some_and(|worst| worst >= least));
    }
    if let Some(most) = expect.fallbacks_at_most {
        let count = days.iter().filter(|day| day.fallback).count();
        add("fallbacks_at_most", json!(most), json!(count), count <= most);
    }
    if let Some(want) = expect.exchange_never_rises {
        let falls = !days.is_empty() && days.iter().all(|day| day.exchange.is_some_and(|spoken| spoken.never_rises));
        add("exchange_never_rises", json!(want), json!(falls), want == falls);
    }
    judged
}

/// A figure of a day that has an upper bound, given the cost of the first day.
type Bound = (&'static str, Option<f64>, fn(&DayFigures, f64) -> Option<f64>);

fn upper_bounds(expect: &BuildingExpect) -> [Bound; 8] {
    [
        ("cost_at_most_share_of_first", expect.cost_at_most_share_of_first, |day, first| {
            Some(day.figures.cost / first)
        }),
        ("tracking_rmse_c_at_most", expect.tracking_rmse_c_at_most, |day, _| Some(day.figures.tracking_rmse_c)),
        ("discomfort_k_h_at_most", expect.discomfort_k_h_at_most, |day, _| Some(day.figures.discomfort_k_h)),
        ("energy_kwh_at_most", expect.energy_kwh_at_most, |day, _| Some(day.figures.energy_kwh)),
        ("input_violation_kw_at_most", expect.input_violation_kw_at_most, |day, _| {
            Some(day.figures.input_violation_kw)
        }),
        ("regret_at_most", expect.regret_at_most, |day, _| day.regret),
        ("spectral_radius_at_most", expect.spectral_radius_at_most, |day, _| day.spectral_radius),
        ("above_centralised_at_most", expect.above_centralised_at_most, |day, _| {
            let spoken = day.exchange?;
            Some(spoken.cost / spoken.centralised_cost? - 1.0)
        }),
    ]
}
