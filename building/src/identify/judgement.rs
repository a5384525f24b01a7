//! From estimates and residual models to a report.

use std::ops::Range;

use super::checks::CheckedEstimate;
use super::continuous::{continuous, decay};
use super::diagnostics::{Confidence, INTERVAL, whiteness};
use super::estimate::Estimate;
use super::free_run::{self, Forecast, RunZone};
use super::physical::{Physical, correlation};
use super::regression::Coefficient;
use super::report::{ErrorReport, FreeRunReport, Report, ResidualReport, WallReport, ZoneReport};
use super::residual::steps;
use super::telemetry::{Neighbour, Telemetry};
use super::{Parts, Settings, horizon};
use crate::discretise;

/// The report on all zones.
pub(super) fn report(
    telemetry: &Telemetry,
    settings: &Settings,
    estimates: &[CheckedEstimate],
    zones: &[RunZone],
    parts: &Parts,
) -> Report {
    let physical = match settings.discretisation {
        discretise::Method::Exact => continuous(telemetry, zones, estimates),
        discretise::Method::Euler => estimates.iter().map(|checked| checked.estimate.clone()).collect(),
    };
    let train = errors(telemetry, settings, zones, &parts.train);
    let test = (!parts.test.is_empty()).then(|| errors(telemetry, settings, zones, &parts.test));
    let reports: Vec<ZoneReport> = (0..zones.len())
        .map(|zone| {
            let test = test.as_ref().map(|test| test[zone].clone());
            zone_report(
                telemetry,
                settings,
                (zone, &zones[zone]),
                (&estimates[zone], &physical[zone]),
                parts,
                (train[zone].clone(), test),
            )
        })
        .collect();
    let walls = walls(telemetry, estimates, &physical, zones);
    let warnings = warnings(telemetry, settings, &reports, zones);
    Report {
        method: settings.method,
        step_s: telemetry.step_s,
        rows: telemetry.rows(),
        train_rows: parts.train.iter().map(Range::len).sum(),
        left_out_rows: telemetry.left_out_rows,
        segments: telemetry.segments.len(),
        zones: reports,
        walls,
        warnings,
    }
}

fn zone_report(
    telemetry: &Telemetry,
    settings: &Settings,
    (zone, run): (usize, &RunZone),
    (checked, continuous): (&CheckedEstimate, &Estimate),
    parts: &Parts,
    (train, test): (ErrorReport, Option<ErrorReport>),
) -> ZoneReport {
    let coefficients = run.model.coefficients(telemetry);
    let estimate = &checked.estimate;
    let count = coefficients.len();
    let order = settings.autoregressive_order;
    // The first r innovations of a segment are zeros, on which the others are conditioned.
    let conditioned = |segment: Range<usize>| segment.start + order..segment.end;
    let tested: Vec<_> = steps(&parts.train).into_iter().filter(|rows| rows.len() > order).map(conditioned).collect();
    ZoneReport {
        name: telemetry.zones[zone].name.clone(),
        coefficients: physical(telemetry, (zone, estimate, checked), &coefficients).coefficients(),
        physical: physical(telemetry, (zone, continuous, checked), &coefficients).quantities(),
        correlations: (0..count)
            .map(|i| (0..count).map(|j| correlation(&estimate.covariance, i, j)).collect())
            .collect(),
        condition_number: Some(estimate.condition_number).filter(|condition| condition.is_finite()),
        residual_model: ResidualReport {
            psi: run.constant.0.psi(),
            constant: run.constant.0.arma.clone(),
            profile: run.daily.0.arma.clone(),
        },
        whiteness: whiteness(&run.daily.1.innovations, &tested, order + 1),
        train,
        test,
    }
}

fn physical<'a>(
    telemetry: &Telemetry,
    (zone, estimate, checks): (usize, &'a Estimate, &'a CheckedEstimate),
    coefficients: &'a [Coefficient],
) -> Physical<'a> {
    let heat_has_unit = telemetry.zones[zone].power_has_unit;
    Physical { coefficients, estimate, checks: &checks.checks, heat_has_unit }
}

/// Errors of every zone on some segments.
fn errors(
    telemetry: &Telemetry,
    settings: &Settings,
    zones: &[RunZone],
    segments: &[Range<usize>],
) -> Vec<ErrorReport> {
    let order = settings.autoregressive_order;
    let rows: Vec<usize> = steps(segments).into_iter().flat_map(|rows| rows.skip(order)).collect();
    let root_mean_square = |series: &[f64]| {
        let sum: f64 = rows.iter().map(|&row| series[row] * series[row]).sum();
        (sum / rows.len().max(1) as f64).sqrt()
    };
    let horizon = horizon(telemetry, settings);
    let runs =
        Forecast::ALL.map(|forecast| (forecast, free_run::errors(telemetry, zones, forecast, segments, horizon)));
    let zone_errors = |(index, zone): (usize, &RunZone)| ErrorReport {
        one_step_k: root_mean_square(&zone.daily.1.q),
        one_step_with_residual_model_k: root_mean_square(&zone.daily.1.innovations),
        free_run: FreeRunReport {
            horizon_h: horizon as f64 * telemetry.step_s / 3600.0,
            runs: runs[0].1.1,
            errors_k: runs
                .iter()
                .map(|(forecast, (errors, runs))| (*forecast, (*runs > 0).then(|| errors[index])))
                .collect(),
        },
    };
    zones.iter().enumerate().map(zone_errors).collect()
}

/// Walls between zones: R_ij is one number, and each side has its own opinion of it.
fn walls(
    telemetry: &Telemetry,
    estimates: &[CheckedEstimate],
    physical_estimates: &[Estimate],
    zones: &[RunZone],
) -> Vec<WallReport> {
    let opinion = |zone: usize, other: usize| {
        let coefficients = zones[zone].model.coefficients(telemetry);
        let to = &telemetry.zones[other].name;
        let index = coefficients.iter().position(|kind| *kind == Coefficient::Wall { to: to.clone() })?;
        let physical = physical(telemetry, (zone, &physical_estimates[zone], &estimates[zone]), &coefficients);
        let conductance = physical.conductance(index, to);
        conductance.value.zip(conductance.standard_error)
    };
    let pairs = telemetry.walls.iter().filter_map(|wall| match wall.other {
        Neighbour::Zone(other) => Some((wall.zone, other)),
        Neighbour::Boundary(_) => None,
    });
    pairs
        .map(|(one, other)| {
            let between = (telemetry.zones[one].name.clone(), telemetry.zones[other].name.clone());
            compare(between, opinion(one, other), opinion(other, one))
        })
        .collect()
}

fn compare(between: (String, String), from_first: Option<(f64, f64)>, from_second: Option<(f64, f64)>) -> WallReport {
    let (combined, words) = match (from_first, from_second) {
        (Some(first), Some(second)) => {
            let distance = (first.0 - second.0).abs() / (first.1 * first.1 + second.1 * second.1).sqrt();
            let precision = (1.0 / (first.1 * first.1), 1.0 / (second.1 * second.1));
            let total = precision.0 + precision.1;
            let mean = (first.0 * precision.0 + second.0 * precision.1) / total;
            match distance {
                distance if distance <= INTERVAL => (
                    Some((mean, 1.0 / total.sqrt())),
                    format!("both sides agree ({distance:.1} standard errors apart)"),
                ),
                _ => (
                    None,
                    format!(
                        "the sides disagree by {distance:.0} standard errors: not one resistance; doors, air flows or hidden masses are at work"
                    ),
                ),
            }
        }
        (Some(one), None) => (Some(one), format!("only {} determines it", between.0)),
        (None, Some(one)) => (Some(one), format!("only {} determines it", between.1)),
        (None, None) => (None, "neither side determines it".into()),
    };
    WallReport { between, from_first, from_second, combined, words }
}

/// Everything that a reader must know before using a number.
fn warnings(telemetry: &Telemetry, settings: &Settings, reports: &[ZoneReport], zones: &[RunZone]) -> Vec<String> {
    let mut warnings = Vec::new();
    if telemetry.left_out_rows > 0 {
        warnings.push(format!("{} rows were left out because a value is missing", telemetry.left_out_rows));
    }
    for (zone, report) in reports.iter().enumerate() {
        let mut warn = |words: &str| warnings.push(format!("{}: {words}", report.name));
        for quantity in &report.coefficients {
            if quantity.verdict.confidence != Confidence::Identified {
                warn(&quantity.verdict.words);
            }
        }
        if report.physical.iter().any(|quantity| quantity.symbol == "c" && quantity.value.is_none()) {
            warn(&report.physical[0].verdict.words);
        }
        if report.whiteness.ljung_box.p_value < 0.05 {
            warn(&format!("residuals are {}", report.whiteness.words));
        }
        if decay(telemetry, zone, &zones[zone]) >= 1.0 {
            warn("the model settles within one sampling time: sample faster, or expect capacities that mean little");
        }
    }
    if reports.iter().any(|report| report.train.free_run.runs == 0) {
        let horizon_h = settings.horizon_h;
        warnings.push(format!(
            "no stretch without a gap is long enough for a free run of {horizon_h} h: lower `horizon_h`"
        ));
    }
    warnings
}
