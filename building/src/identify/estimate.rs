//! The two estimators of a zone's coefficients.
//!
//! **`semiparametric`** (the dissertation, eq. 2.4 to 2.10): every series minus its kernel smooth, which removes the
//! non-parametric term; then one Newton step. Unknown heat that varies faster than the bandwidth biases the result. So does
//! sensor noise, which the smoother removes less than the signal: conductances come out too large.
//!
//! **`prediction-error`**: the zone model with a constant, daily harmonics and ARMA(r,1) errors, all fitted at once so that
//! the one-step prediction error is smallest. The error model takes the place of the smoother; its moving average
//! absorbs much of the sensor noise.

use std::ops::Range;

use nalgebra::DMatrix;

use super::normal::{LogLikelihood, robust_covariance};
use super::regression::{Regression, ZoneModel};
use super::telemetry::Telemetry;
use super::{Estimator, IdentifyError, IdentifySettings, arma};
use crate::staged::dense::dot;

/// Coefficients of one zone, in the order of its model's terms.
#[derive(Debug, Clone)]
pub(super) struct Estimate {
    /// The coefficients, none of them negative.
    pub coefficients: Vec<f64>,
    /// The coefficients before the condition that none is negative.
    pub unconstrained: Vec<f64>,
    /// Covariance of the unconstrained ones; an infinite variance means that the data do not determine one.
    pub covariance: DMatrix<f64>,
}

/// Estimates the coefficients of `model` on `segments` of the telemetry.
///
/// # Errors
/// [`IdentifyError`] when there are too few rows.
pub(super) fn estimate(
    telemetry: &Telemetry,
    model: &ZoneModel,
    segments: &[Range<usize>],
    settings: &IdentifySettings,
) -> Result<Estimate, IdentifyError> {
    match settings.method {
        Estimator::Semiparametric => semiparametric(telemetry, model, segments, settings),
        // The method `state-space` has its own estimator for all zones together.
        Estimator::PredictionError | Estimator::StateSpace => prediction_error(telemetry, model, segments, settings),
    }
}

fn semiparametric(
    telemetry: &Telemetry,
    model: &ZoneModel,
    segments: &[Range<usize>],
    settings: &IdentifySettings,
) -> Result<Estimate, IdentifyError> {
    let bandwidth = settings.bandwidth_h * 3600.0 / telemetry.step_s;
    let regression = Regression::new(telemetry, model, segments, Some(bandwidth));
    let (rows, parameters) = (regression.target.len(), regression.columns.len());
    if rows < 3 * parameters {
        return Err(IdentifyError::TooFewRows { rows, parameters, wanted: 3 * parameters });
    }
    let likelihood = LogLikelihood::new(&regression);
    let unconstrained = likelihood.maximum();
    // The residual of a disturbance after the smoother is correlated over about two bandwidths.
    let lags = libm::ceil(2.0 * bandwidth) as usize;
    let covariance =
        robust_covariance(&regression.columns, &regression.residuals(&unconstrained), &regression.segments, lags);
    let coefficients = likelihood.non_negative_maximum();
    Ok(Estimate { coefficients, unconstrained, covariance })
}

fn prediction_error(
    telemetry: &Telemetry,
    model: &ZoneModel,
    segments: &[Range<usize>],
    settings: &IdentifySettings,
) -> Result<Estimate, IdentifyError> {
    let regression = Regression::new(telemetry, model, segments, None);
    let count = regression.columns.len();
    let known = known_ahead(telemetry, &regression.rows, settings.harmonics);
    let fit = |kept: &[usize]| {
        let columns: Vec<_> =
            kept.iter().map(|&index| regression.columns[index].clone()).chain(known.clone()).collect();
        arma::fit(&columns, &regression.target, &regression.segments, settings.autoregressive_order)
    };
    let mut kept: Vec<usize> = (0..count).collect();
    let free = fit(&kept)?;
    let mut current = free.regression.clone();
    // The most negative coefficient, scaled by the length of its column, is fixed at zero until none is negative.
    let effect = |index: usize, value: f64| value * column_length(&regression.columns[index]);
    loop {
        let negative = kept.iter().enumerate().filter(|(at, _)| current[*at] < 0.0);
        let worst = negative.min_by(|a, b| effect(*a.1, current[a.0]).total_cmp(&effect(*b.1, current[b.0])));
        let Some((at, _)) = worst else { break };
        kept.remove(at);
        current = fit(&kept)?.regression;
    }
    let mut coefficients = vec![0.0; count];
    kept.iter().zip(&current).for_each(|(&index, &value)| coefficients[index] = value);
    Ok(Estimate {
        coefficients,
        unconstrained: free.regression[..count].to_vec(),
        covariance: free.covariance.view((0, 0), (count, count)).into_owned(),
    })
}

fn column_length(column: &[f64]) -> f64 {
    dot(column, column).sqrt()
}

/// The deterministic regressors of the disturbance: a constant, and `harmonics` of the day, at the start of each step.
pub(super) fn known_ahead(telemetry: &Telemetry, rows: &[usize], harmonics: usize) -> Vec<Vec<f64>> {
    let angle =
        |row: usize, harmonic: usize| harmonic as f64 * 2.0 * std::f64::consts::PI * telemetry.time_s[row] / 86_400.0;
    let mut columns = vec![vec![1.0; rows.len()]];
    for harmonic in 1..=harmonics {
        columns.push(rows.iter().map(|&row| libm::sin(angle(row, harmonic))).collect());
        columns.push(rows.iter().map(|&row| libm::cos(angle(row, harmonic))).collect());
    }
    columns
}
