//! The outcome for a building.

use std::fmt::Write;

use interplay_scenarios::{BuildingExpect, Scenario};
use serde::Serialize;
use serde_json::{Value, json};

use super::Expectation;
use crate::measure::{BuildingDigests, BuildingMeasures, DayFigures};

/// The most days that a summary lists.
const LISTED: usize = 14;

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
    type Bound = (&'static str, Option<f64>, fn(&DayFigures, f64) -> f64);
    let bounds: [Bound; 5] = [
        ("cost_at_most_share_of_first", expect.cost_at_most_share_of_first, |day, first| day.figures.cost / first),
        ("tracking_rmse_c_at_most", expect.tracking_rmse_c_at_most, |day, _| day.figures.tracking_rmse_c),
        ("discomfort_k_h_at_most", expect.discomfort_k_h_at_most, |day, _| day.figures.discomfort_k_h),
        ("energy_kwh_at_most", expect.energy_kwh_at_most, |day, _| day.figures.energy_kwh),
        ("input_violation_kw_at_most", expect.input_violation_kw_at_most, |day, _| day.figures.input_violation_kw),
    ];
    for (what, most, figure) in bounds {
        let Some(most) = most else { continue };
        let worst = days.iter().map(|day| figure(day, first)).max_by(f64::total_cmp);
        add(what, json!(most), json!(worst), worst.is_some_and(|worst| worst <= most));
    }
    judged
}

/// The days as a table.
pub(super) fn write(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let radius = building.iterations.first().and_then(|day| day.spectral_radius);
    let radius = radius.map(|radius| format!(", spectral radius {radius:.3}")).unwrap_or_default();
    writeln!(text, "  {} zones, controller {}{radius}", building.zones, building.controller)?;
    for remark in &building.remarks {
        writeln!(text, "  note: {remark}")?;
    }
    writeln!(
        text,
        "  {:>4}  {:>9}  {:>9}  {:>6}  {:>14}  {:>10}  {:>7}  {:>13}  {:>9}",
        "day", "cost", "regret", "rmse K", "discomfort K·h", "energy kWh", "peak kW", "over limit kW", "design ms"
    )?;
    let count = building.iterations.len();
    for (index, day) in building.iterations.iter().enumerate() {
        if count > LISTED && (LISTED / 2..count - LISTED / 2).contains(&index) {
            if index == LISTED / 2 {
                writeln!(text, "     …  {} more in --json", count - LISTED)?;
            }
            continue;
        }
        let figures = &day.figures;
        let regret = day.regret.map_or_else(|| "-".to_owned(), |regret| format!("{regret:.2}"));
        writeln!(
            text,
            "  {:>4}  {:>9.2}  {regret:>9}  {:>6.3}  {:>14.3}  {:>10.2}  {:>7.2}  {:>13.3}  {:>9.2}",
            index + 1,
            figures.cost,
            figures.tracking_rmse_c,
            figures.discomfort_k_h,
            figures.energy_kwh,
            figures.peak_kw,
            figures.input_violation_kw,
            1e3 * day.design_s
        )?;
    }
    Ok(())
}
