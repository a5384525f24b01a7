//! Thermal parameters from telemetry (chapter 2).
//!
//! The temperature of each zone follows its neighbours and the known heat; the dissertation calls everything
//! else the non-parametric term q:
//!
//! ```text
//! T_i(t+1) = T_i(t) + T_s Σ_k b_ik (T_k(t) − T_i(t)) + T_s a_i (u_i(t) + w_i(t)) + q_i(t) + ε(t)      (2.4, corrected)
//! ```
//!
//! By default [`identify`] estimates networks with hidden temperatures by maximum likelihood (`state_space`). Two other
//! [`Estimator`]s estimate b and a by regression, turn them into capacities and resistances, and model q. All report how
//! certain each number is: standard errors, intervals, whiteness of the residuals, errors of free runs, and which parameters
//! the data do not determine. [`Telemetry`] comes from a CSV and a [`Mapping`], or from a simulation such as [`synthetic_classroom`].

mod arma;
mod continuous;
mod diagnostics;
mod error;
mod estimate;
mod findings;
mod free_run;
mod normal;
mod physical;
mod regression;
mod report;
mod settings;
mod smoothing;
mod state_space;
pub mod synthetic_classroom;
mod telemetry;

pub use arma::Arma;
pub use diagnostics::{Confidence, LjungBox, ParameterVerdict, Whiteness};
pub use error::IdentifyError;
pub use free_run::ResidualForecast;
pub use report::{
    CrossCheck, ErrorReport, FreeRunReport, Identification, IdentificationReport, IdentifiedNetwork, ModelRow,
    NetworkUncertainty, Quantity, ResidualReport, SuspectedCause, Suspicion, WallReport, ZoneReport, ZoneSeries,
};
pub use settings::{Estimator, HiddenTemperature, IdentifySettings};
pub use telemetry::{
    AirFlowUnit, Boundary, BoundaryColumns, ComputedColumn, DecimalSign, EnergyUnit, Gaps, HeatColumns, Hold,
    IrradianceUnit, Mapping, MeasuredWall, MeasuredZone, MeterReading, Neighbour, PowerUnit, RecordedDays, SolarColumn,
    SupplyAir, TableForm, Telemetry, TelemetryError, TemperatureUnit, TimeAxis, WaterFlowUnit, ZoneColumns,
};

use std::ops::Range;

use estimate::{Estimate, estimate};
use findings::Findings;
use free_run::RunZone;
use regression::{ResidualModel, ResidualSeries, ZoneModel, steps};
use settings::TrainTestSplit;

/// Receives a few words about the next fit while an identification runs, from any thread.
pub type Progress<'a> = dyn Fn(&str) + Sync + 'a;

/// Identifies every zone of the telemetry.
///
/// # Errors
/// [`IdentifyError`] for a setting out of range, a zone without anything to identify or whose temperature never changes, or too few
/// rows. A parameter that the
/// data do not determine is not an error: its [`ParameterVerdict`] says so.
pub fn identify(telemetry: &Telemetry, settings: &IdentifySettings) -> Result<Identification, IdentifyError> {
    identify_with_progress(telemetry, settings, &|_| {})
}

/// Processor time of [`identify`] on one core of the reference machine, to about a factor of three \[s\]; zero for the
/// other methods.
pub fn expected_processor_s(telemetry: &Telemetry, settings: &IdentifySettings) -> f64 {
    match settings.method {
        Estimator::StateSpace => state_space::expected_processor_s(telemetry, settings),
        Estimator::Semiparametric | Estimator::PredictionError => 0.0,
    }
}

/// As [`identify`], and reports to `progress` which fit comes next. Only `state-space` takes long enough to report anything.
///
/// # Errors
/// As [`identify`].
pub fn identify_with_progress(
    telemetry: &Telemetry,
    settings: &IdentifySettings,
    progress: &Progress<'_>,
) -> Result<Identification, IdentifyError> {
    settings.check(telemetry.step_s)?;
    let mut found = by_method(telemetry, settings, progress)?;
    found.report.warnings.extend(findings::remarks(telemetry));
    Ok(found)
}

fn by_method(
    telemetry: &Telemetry,
    settings: &IdentifySettings,
    progress: &Progress<'_>,
) -> Result<Identification, IdentifyError> {
    let split = TrainTestSplit::new(telemetry, settings);
    refuse_constant_temperatures(telemetry, &split.train)?;
    if settings.method == Estimator::StateSpace {
        return state_space::identify(telemetry, settings, progress);
    }
    let is_incomplete = |zone: &&MeasuredZone| zone.temperature_c.iter().any(|value| value.is_nan());
    if let Some(zone) = telemetry.zones.iter().find(is_incomplete) {
        return Err(IdentifyError::MissingTemperature { zone: zone.name.clone() });
    }
    let fits = (0..telemetry.zones.len())
        .map(|zone| fit_zone(telemetry, zone, &split.train, settings))
        .collect::<Result<Vec<_>, _>>()?;
    let (estimates, zones): (Vec<Estimate>, Vec<RunZone>) = fits.into_iter().unzip();
    let findings = Findings { telemetry, settings, split: &split, estimates: &estimates, zones: &zones };
    let report = findings.report();
    let network = Err("only the method `state-space` makes a network of what it finds".into());
    Ok(Identification { report, series: series(telemetry, settings, &zones, split.test_start), network })
}

/// Refuses a zone whose temperature has one value in all rows that are trained on.
fn refuse_constant_temperatures(telemetry: &Telemetry, train: &[Range<usize>]) -> Result<(), IdentifyError> {
    for zone in &telemetry.zones {
        let trained = train.iter().flat_map(|rows| &zone.temperature_c[rows.clone()]).filter(|value| !value.is_nan());
        let values: Vec<f64> = trained.copied().collect();
        if let [first, others @ ..] = values.as_slice()
            && !others.is_empty()
            && others.iter().all(|value| value == first)
        {
            let (zone, value_c) = (zone.name.clone(), *first);
            return Err(IdentifyError::ConstantTemperature { zone, value_c, rows: values.len() });
        }
    }
    Ok(())
}

/// Estimates a zone's coefficients and models the residuals.
fn fit_zone(
    telemetry: &Telemetry,
    zone: usize,
    train: &[Range<usize>],
    settings: &IdentifySettings,
) -> Result<(Estimate, RunZone), IdentifyError> {
    let model = ZoneModel::new(telemetry, zone);
    if model.coefficients(telemetry).is_empty() {
        return Err(IdentifyError::NothingToIdentify { zone: telemetry.zones[zone].name.clone() });
    }
    let estimate = estimate(telemetry, &model, train, settings)?;
    let coefficients = estimate.coefficients.clone();
    let residual = |harmonics: usize| -> Result<(ResidualModel, ResidualSeries), IdentifyError> {
        let order = (settings.autoregressive_order, harmonics);
        let fitted = ResidualModel::fit(telemetry, &model, &coefficients, train, order)?;
        let series = fitted.series(telemetry, &model, &coefficients);
        Ok((fitted, series))
    };
    let (constant, daily) = (residual(0)?, residual(settings.harmonics)?);
    Ok((estimate, RunZone { model, coefficients, constant, daily }))
}

fn series(telemetry: &Telemetry, settings: &IdentifySettings, zones: &[RunZone], test_start: usize) -> Vec<ZoneSeries> {
    let horizon = settings.horizon_steps(telemetry.step_s);
    let free = free_run::restarted(telemetry, zones, ResidualForecast::None, horizon);
    let with_residual = free_run::restarted(telemetry, zones, ResidualForecast::ProfileArma, horizon);
    let draw = |(zone, (free_run_c, free_run_with_residual_model_c)): (usize, (Vec<f64>, Vec<f64>))| {
        let measured = &telemetry.zones[zone];
        let residuals = &zones[zone].daily.1;
        let mut one_step_c = measured.temperature_c.clone();
        for segment in steps(&telemetry.segments) {
            // Before there are r rows for the ARMA model, the daily profile predicts alone.
            let with_arma = segment.start + settings.autoregressive_order;
            for row in segment {
                one_step_c[row + 1] -= if row < with_arma { residuals.errors[row] } else { residuals.innovations[row] };
            }
        }
        ZoneSeries {
            name: measured.name.clone(),
            time_s: telemetry.time_s.clone(),
            segment_starts: telemetry.segments.iter().map(|segment| segment.start).collect(),
            test_start,
            measured_c: measured.temperature_c.clone(),
            one_step_c,
            free_run_c,
            free_run_with_residual_model_c: Some(free_run_with_residual_model_c),
            innovations_k: residuals.innovations.clone(),
        }
    };
    free.into_iter().zip(with_residual).enumerate().map(draw).collect()
}
