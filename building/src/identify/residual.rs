//! The model of the non-parametric term q, eq. 2.11 and 2.12, so that the network can predict.
//!
//! q is the residual of the network in each step, computed from the measured temperatures. The dissertation uses smoothed ones,
//! but a smoother uses future values, which a forecast does not have. Two models are fitted: a constant with ARMA(r,1), as in the dissertation, and
//! a daily profile (harmonics) with ARMA(r,1).

use std::ops::Range;

use super::estimate::known_ahead;
use super::regression::{Regression, ZoneModel};
use super::telemetry::Telemetry;
use super::{Arma, IdentifyError, arma};

/// A model of q: z_tᵀβ plus ARMA.
#[derive(Debug, Clone)]
pub(super) struct ResidualModel {
    harmonics: usize,
    /// β \[K per step\].
    profile: Vec<f64>,
    pub arma: Arma,
}

/// A residual model applied to a zone's measurements. Every series has one value a row of the telemetry; a row that no
/// step starts from has zeros.
#[derive(Debug, Clone)]
pub(super) struct ResidualSeries {
    /// q_t \[K per step\].
    pub q: Vec<f64>,
    /// z_tᵀβ.
    pub profile: Vec<f64>,
    /// v_t = q_t − z_tᵀβ.
    pub errors: Vec<f64>,
    /// e_t.
    pub innovations: Vec<f64>,
}

impl ResidualModel {
    /// Fits the model to the residuals of `coefficients` on `segments`.
    ///
    /// # Errors
    /// [`IdentifyError`] when there are too few rows.
    pub fn fit(
        telemetry: &Telemetry,
        model: &ZoneModel,
        coefficients: &[f64],
        segments: &[Range<usize>],
        (order, harmonics): (usize, usize),
    ) -> Result<Self, IdentifyError> {
        let regression = Regression::new(telemetry, model, segments, None);
        let known = known_ahead(telemetry, &regression.rows, harmonics);
        let fit = arma::fit(&known, &regression.residuals(coefficients), &regression.segments, order)?;
        Ok(Self { harmonics, profile: fit.regression, arma: fit.arma })
    }

    /// Applies the model to all segments of the telemetry.
    pub fn series(&self, telemetry: &Telemetry, model: &ZoneModel, coefficients: &[f64]) -> ResidualSeries {
        let regression = Regression::new(telemetry, model, &telemetry.segments, None);
        let all_rows: Vec<usize> = (0..telemetry.rows()).collect();
        let mut profile = vec![0.0; telemetry.rows()];
        for (column, coefficient) in known_ahead(telemetry, &all_rows, self.harmonics).iter().zip(&self.profile) {
            profile.iter_mut().zip(column).for_each(|(sum, value)| *sum += coefficient * value);
        }
        let (mut q, mut errors) = (vec![0.0; telemetry.rows()], vec![0.0; telemetry.rows()]);
        for (&row, rest) in regression.rows.iter().zip(regression.residuals(coefficients)) {
            q[row] = rest;
            errors[row] = rest - profile[row];
        }
        let innovations = self.arma.innovations(&errors, &steps(&telemetry.segments));
        ResidualSeries { q, profile, errors, innovations }
    }

    /// ψ of the printed form (2.12), β_0 (1 − Σα), of the constant part \[K per step\].
    pub fn psi(&self) -> f64 {
        self.profile[0] * (1.0 - self.arma.autoregressive.iter().sum::<f64>())
    }
}

/// The rows of each segment from which a step starts: all but the last.
pub(super) fn steps(segments: &[Range<usize>]) -> Vec<Range<usize>> {
    segments.iter().filter(|segment| segment.len() >= 2).map(|segment| segment.start..segment.end - 1).collect()
}
