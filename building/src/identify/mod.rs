//! Thermal parameters from telemetry (chapter 2).
//!
//! Each zone follows its neighbours, warms with known heat, and does something else besides, the non-parametric term q:
//!
//! ```text
//! T_i(t+1) = T_i(t) + T_s Σ_k b_ik (T_k(t) − T_i(t)) + T_s a_i (u_i(t) + w_i(t)) + q_i(t) + ε(t)      (2.4, corrected)
//! ```
//!
//! [`identify`] estimates b and a by one of two [`Estimator`]s, turns them into capacities and resistances, models q, and says
//! how far each number can be trusted: standard errors, correlations, whether residuals are white, how a free run errs, and
//! where the data cannot tell. [`Telemetry`] comes from a CSV and a [`Mapping`], or from a simulation such as [`synthetic_classroom`].

mod arma;
mod continuous;
mod cross_checks;
mod diagnostics;
mod estimate;
mod findings;
mod free_run;
mod normal;
mod physical;
mod regression;
mod report;
mod residual;
mod settings;
mod shared_walls;
mod smoothing;
pub mod synthetic_classroom;
mod telemetry;

pub use arma::Arma;
pub use diagnostics::{Confidence, LjungBox, ParameterVerdict, Whiteness};
pub use free_run::ResidualForecast;
pub use report::{
    CrossCheck, ErrorReport, FreeRunReport, Identification, IdentificationReport, Quantity, ResidualReport, WallReport,
    ZoneReport, ZoneSeries,
};
pub use settings::{Estimator, IdentifySettings};
pub use smoothing::local_linear;
pub use telemetry::{
    AirFlowUnit, Boundary, BoundaryColumns, Gaps, HeatColumns, IrradianceUnit, Mapping, MeasuredWall, MeasuredZone,
    Neighbour, PowerUnit, SolarColumn, SupplyAir, TableForm, Telemetry, TelemetryError, TelemetryProblem,
    TemperatureUnit, TimeAxis, WaterFlowUnit, ZoneColumns,
};

use std::ops::Range;

use crate::setting::SettingError;

use cross_checks::CheckedEstimate;
use findings::Findings;
use free_run::RunZone;
use regression::ZoneModel;
use residual::{ResidualModel, ResidualSeries, steps};

/// Why an identification is not possible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IdentifyError {
    /// A setting makes no sense.
    #[error("setting {0}")]
    Setting(#[from] SettingError),
    /// A zone has neither walls nor heat nor sun.
    #[error("zone `{zone}` has no wall, no heat and no sun: give it at least one, or there is nothing to identify")]
    NothingToIdentify {
        /// The zone.
        zone: String,
    },
    /// There are too few rows.
    #[error(
        "{rows} usable steps are too few for {parameters} parameters: at least {wanted} are needed; add rows, raise `train_days`, or lower `harmonics` or `autoregressive_order`"
    )]
    TooFewRows {
        /// Usable steps.
        rows: usize,
        /// Parameters to fit.
        parameters: usize,
        /// How many would do.
        wanted: usize,
    },
    /// A fit has no finite error.
    #[error("the residuals are not finite: check the telemetry for values that are not")]
    NotFinite,
}

/// Identifies every zone of the telemetry.
///
/// # Errors
/// [`IdentifyError`] for a setting that makes no sense, a zone without anything to identify, or too few rows. That the data
/// do not determine a parameter is no error: its [`ParameterVerdict`] says so.
pub fn identify(telemetry: &Telemetry, settings: &IdentifySettings) -> Result<Identification, IdentifyError> {
    settings.check(telemetry.step_s)?;
    let test_start = test_start(telemetry, settings);
    let (train, test) = telemetry.split_at(test_start);
    let fits = (0..telemetry.zones.len())
        .map(|zone| fit_zone(telemetry, zone, &train, settings))
        .collect::<Result<Vec<_>, _>>()?;
    let (estimates, zones): (Vec<CheckedEstimate>, Vec<RunZone>) = fits.into_iter().unzip();
    let parts = Parts { train, test, test_start };
    let findings = Findings { telemetry, settings, parts: &parts, estimates: &estimates, zones: &zones };
    let report = findings.report();
    Ok(Identification { report, series: series(telemetry, settings, &zones, &parts) })
}

/// Rows to train and to test on.
struct Parts {
    train: Vec<Range<usize>>,
    test: Vec<Range<usize>>,
    test_start: usize,
}

/// The first row that is not trained on.
fn test_start(telemetry: &Telemetry, settings: &IdentifySettings) -> usize {
    let Some((days, first)) = settings.train_days.zip(telemetry.time_s.first()) else { return telemetry.rows() };
    let end_s = first + days * 86_400.0;
    telemetry.time_s.iter().position(|&time| time >= end_s).unwrap_or(telemetry.rows())
}

/// Estimates a zone's coefficients and models what they leave.
fn fit_zone(
    telemetry: &Telemetry,
    zone: usize,
    train: &[Range<usize>],
    settings: &IdentifySettings,
) -> Result<(CheckedEstimate, RunZone), IdentifyError> {
    let model = ZoneModel::new(telemetry, zone);
    if model.coefficients(telemetry).is_empty() {
        return Err(IdentifyError::NothingToIdentify { zone: telemetry.zones[zone].name.clone() });
    }
    let estimate = CheckedEstimate::new(telemetry, &model, train, settings)?;
    let coefficients = estimate.estimate.coefficients.clone();
    let residual = |harmonics: usize| -> Result<(ResidualModel, ResidualSeries), IdentifyError> {
        let order = (settings.autoregressive_order, harmonics);
        let fitted = ResidualModel::fit(telemetry, &model, &coefficients, train, order)?;
        let series = fitted.series(telemetry, &model, &coefficients);
        Ok((fitted, series))
    };
    let (constant, daily) = (residual(0)?, residual(settings.harmonics)?);
    Ok((estimate, RunZone { model, coefficients, constant, daily }))
}

/// Steps of a free run.
fn horizon(telemetry: &Telemetry, settings: &IdentifySettings) -> usize {
    libm::round(settings.horizon_h * 3600.0 / telemetry.step_s) as usize
}

fn series(telemetry: &Telemetry, settings: &IdentifySettings, zones: &[RunZone], parts: &Parts) -> Vec<ZoneSeries> {
    let horizon = horizon(telemetry, settings);
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
            test_start: parts.test_start,
            measured_c: measured.temperature_c.clone(),
            one_step_c,
            free_run_c,
            free_run_with_residual_model_c,
            innovations_k: residuals.innovations.clone(),
        }
    };
    free.into_iter().zip(with_residual).enumerate().map(draw).collect()
}
