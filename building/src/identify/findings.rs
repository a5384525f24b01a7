//! Makes a report from estimates and residual models.

use std::ops::Range;

use interplay_common::spelling::counted;

use super::continuous::{continuous, decay};
use super::diagnostics::{Confidence, whiteness};
use super::estimate::Estimate;
use super::free_run::{self, ResidualForecast, RunZone};
use super::physical::Physical;
use super::regression::{Coefficient, steps};
use super::report::{ErrorReport, FreeRunReport, IdentificationReport, ResidualReport, ZoneReport};
use super::settings::{IdentifySettings, TrainTestSplit};
use super::telemetry::{MeasuredZone, Telemetry};
use crate::discretise;

/// Everything that a report is made from.
pub(super) struct Findings<'a> {
    pub telemetry: &'a Telemetry,
    pub settings: &'a IdentifySettings,
    pub split: &'a TrainTestSplit,
    pub estimates: &'a [Estimate],
    pub zones: &'a [RunZone],
}

impl Findings<'_> {
    /// The report on all zones.
    pub fn report(&self) -> IdentificationReport {
        let physical = match self.settings.discretisation {
            discretise::Discretisation::Exact => continuous(self.telemetry, self.zones, self.estimates),
            discretise::Discretisation::Euler => self.estimates.to_vec(),
        };
        let train = self.errors(&self.split.train);
        let test = (!self.split.test.is_empty()).then(|| self.errors(&self.split.test));
        let zone = |zone: usize| {
            let test = test.as_ref().map(|test| test[zone].clone());
            self.zone(zone, &physical[zone], train[zone].clone(), test)
        };
        let zones: Vec<ZoneReport> = (0..self.zones.len()).map(zone).collect();
        IdentificationReport {
            method: self.settings.method,
            step_s: self.telemetry.step_s,
            rows: self.telemetry.rows(),
            train_rows: self.split.train.iter().map(Range::len).sum(),
            left_out_rows: self.telemetry.left_out_rows,
            segments: self.telemetry.segments.len(),
            warnings: self.warnings(&zones),
            walls: Vec::new(),
            models: Vec::new(),
            suspicions: Vec::new(),
            zones,
        }
    }

    /// The report on one zone; `continuous` is its estimate as rates of the continuous network.
    fn zone(&self, zone: usize, continuous: &Estimate, train: ErrorReport, test: Option<ErrorReport>) -> ZoneReport {
        let run = &self.zones[zone];
        let estimate = &self.estimates[zone];
        let coefficients = run.model.coefficients(self.telemetry);
        let order = self.settings.autoregressive_order;
        // The first r innovations of a segment are zeros, on which the others are conditioned.
        let long_enough = steps(&self.split.train).into_iter().filter(|rows| rows.len() > order);
        let judged: Vec<_> = long_enough.map(|rows| rows.start + order..rows.end).collect();
        ZoneReport {
            name: self.telemetry.zones[zone].name.clone(),
            coefficients: self.physical(zone, estimate, &coefficients).coefficients(),
            physical: self.physical(zone, continuous, &coefficients).quantities(),
            correlations: Vec::new(),
            condition_number: None,
            residual_model: Some(ResidualReport {
                psi: run.constant.0.psi(),
                constant: run.constant.0.arma.clone(),
                profile: run.daily.0.arma.clone(),
            }),
            whiteness: whiteness(&run.daily.1.innovations, &judged, order + 1),
            train,
            test,
        }
    }

    fn physical<'b>(&'b self, zone: usize, estimate: &'b Estimate, coefficients: &'b [Coefficient]) -> Physical<'b> {
        let heat_has_unit = self.telemetry.zones[zone].power_has_unit;
        Physical { coefficients, estimate, heat_has_unit }
    }

    /// Errors of every zone on some segments.
    fn errors(&self, segments: &[Range<usize>]) -> Vec<ErrorReport> {
        let order = self.settings.autoregressive_order;
        let rows: Vec<usize> = steps(segments).into_iter().flat_map(|rows| rows.skip(order)).collect();
        let root_mean_square = |series: &[f64]| {
            let sum: f64 = rows.iter().map(|&row| series[row] * series[row]).sum();
            (sum / rows.len().max(1) as f64).sqrt()
        };
        let horizon = self.settings.horizon_steps(self.telemetry.step_s);
        let runs = ResidualForecast::ALL
            .map(|how| (how, free_run::errors(self.telemetry, self.zones, how, segments, horizon)));
        let zone_errors = |(index, zone): (usize, &RunZone)| ErrorReport {
            one_step_k: root_mean_square(&zone.daily.1.q),
            one_step_with_residual_model_k: Some(root_mean_square(&zone.daily.1.innovations)),
            free_run: FreeRunReport {
                horizon_h: horizon as f64 * self.telemetry.step_s / 3600.0,
                runs: runs[0].1.runs,
                errors_k: runs.iter().map(|(how, errors)| (*how, errors.of_zone(index))).collect(),
                mean_of_data_k: None,
            },
        };
        self.zones.iter().enumerate().map(zone_errors).collect()
    }

    /// Warnings about numbers that must not be used without a second look.
    fn warnings(&self, reports: &[ZoneReport]) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.telemetry.left_out_rows > 0 {
            let rows = counted(self.telemetry.left_out_rows, "row");
            warnings.push(format!("{rows} left out because a value is missing"));
        }
        for (zone, report) in reports.iter().enumerate() {
            let mut warn = |words: &str| warnings.push(format!("{}: {words}", report.name));
            let doubtful = report.coefficients.iter().filter(|it| it.verdict.confidence != Confidence::Identified);
            doubtful.for_each(|quantity| warn(&quantity.verdict.words));
            let capacity = report.physical.iter().find(|quantity| quantity.symbol == "c" && quantity.value.is_none());
            capacity.iter().for_each(|quantity| warn(&quantity.verdict.words));
            if report.whiteness.ljung_box.p_value < 0.05 {
                warn(&format!("residuals are {}", report.whiteness.words));
            }
            if decay(self.telemetry, zone, &self.zones[zone]) >= 1.0 {
                warn(
                    "the model settles within one sampling time: sample faster, or expect capacities that mean little",
                );
            }
        }
        if reports.iter().any(|report| report.train.free_run.runs == 0) {
            let horizon_h = self.settings.horizon_h;
            let words = "no stretch without a gap is long enough for a free run";
            warnings.push(format!("{words} of {horizon_h} h: lower `horizon_h`"));
        }
        warnings
    }
}

/// The most heat of a usual zone: that of a large hall \[kW\].
const MOST_KW: f64 = 200.0;
/// The least heat whose effect a sensor sees: that of a small lamp \[kW\].
const LEAST_KW: f64 = 0.005;

/// A remark on each zone whose measured heat is unusually large or small throughout.
pub(super) fn remarks(telemetry: &Telemetry) -> Vec<String> {
    telemetry.zones.iter().filter_map(remark).collect()
}

fn remark(zone: &MeasuredZone) -> Option<String> {
    let largest_kw =
        zone.power_kw.iter().filter(|power| power.is_finite()).fold(0.0_f64, |most, power| most.max(power.abs()));
    let advice = "is the `unit` in the mapping right? Capacities and conductances follow it";
    match largest_kw {
        much if much > MOST_KW => Some(format!("{}: its heat reaches {much:.0} kW; {advice}", zone.name)),
        little if little > 0.0 && little < LEAST_KW => {
            Some(format!("{}: its heat is never above {:.2} W; {advice}", zone.name, 1000.0 * little))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::synthetic_classroom::Classroom;

    #[test]
    fn heat_in_watts_instead_of_kilowatts_is_remarked_upon() {
        let telemetry = Classroom { days: 1, ..Classroom::default() }.simulate();
        assert!(remarks(&telemetry).is_empty());
        for (factor, word) in [(1000.0, "reaches"), (0.0001, "never above")] {
            let mut wrong = telemetry.clone();
            wrong.zones[0].power_kw.iter_mut().for_each(|power| *power *= factor);
            let said = remarks(&wrong);
            assert!(said.len() == 1 && said[0].contains(word), "{said:?}");
        }
    }
}
