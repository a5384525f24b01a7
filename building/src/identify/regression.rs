//! The zone model as a linear regression, eq. 2.3 corrected:
//!
//! ```text
//! T_i(t+1) − T_i(t) = T_s Σ_k b_ik (T_k(t) − T_i(t)) + T_s a_i (u_i(t) + w_i(t)) + T_s s_i I_i(t) + q_i(t) + ε(t)
//! ```
//!
//! linear in b_ik = 1/(c_i R_ik), a_i = 1/c_i and, where irradiance I is measured, s_i = A_i/c_i with an aperture A_i. The
//! dissertation drops T_s on a_i, and on w_i where it cancels nothing.
//!
//! The model of the non-parametric term q, eq. 2.11 and 2.12, so that the network can predict.
//!
//! q is the residual of the network in each step, computed from the measured temperatures. The dissertation uses smoothed ones,
//! but a smoother uses future values, which a forecast does not have. Two models are fitted: a constant with ARMA(r,1), as in the dissertation, and
//! a daily profile (harmonics) with ARMA(r,1).

use std::ops::Range;

use serde::Serialize;

use super::estimate::known_ahead;
use super::smoothing::without_smooth;
use super::telemetry::{Neighbour, Telemetry};
use super::{Arma, IdentifyError, arma};

/// One coefficient of the zone model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Coefficient {
    /// b_ik: how fast the zone follows a neighbour \[1/s\].
    Wall {
        /// The neighbour's name.
        to: String,
    },
    /// a_i: how fast heat warms the zone \[K/kJ\]; per unit of the heat signal and second if that has no unit.
    Heat,
    /// s_i: how fast irradiance warms the zone \[K·m²/kJ\].
    Solar,
}

/// The terms of a zone's model, in the order of its coefficients.
#[derive(Debug, Clone)]
pub(super) struct ZoneModel {
    zone: usize,
    terms: Vec<Term>,
}

#[derive(Debug, Clone, Copy)]
enum Term {
    Wall(Neighbour),
    Heat,
    Solar,
}

impl ZoneModel {
    /// The zone model with a term for each measured quantity.
    pub fn new(telemetry: &Telemetry, zone: usize) -> Self {
        let measured = &telemetry.zones[zone];
        let mut terms: Vec<_> = telemetry.neighbours(zone).into_iter().map(Term::Wall).collect();
        terms.extend(measured.has_heat().then_some(Term::Heat));
        terms.extend(measured.irradiance_kw_per_m2.is_some().then_some(Term::Solar));
        Self { zone, terms }
    }

    /// The coefficients of the model, in order.
    pub fn coefficients(&self, telemetry: &Telemetry) -> Vec<Coefficient> {
        let name = |term: &Term| match *term {
            Term::Wall(neighbour) => Coefficient::Wall { to: telemetry.name(neighbour).into() },
            Term::Heat => Coefficient::Heat,
            Term::Solar => Coefficient::Solar,
        };
        self.terms.iter().map(name).collect()
    }

    /// The regressors of one row, T_s included, if the zones had the temperatures `zones_c`.
    pub fn regressors<'a>(
        &'a self,
        telemetry: &'a Telemetry,
        row: usize,
        zones_c: &'a [f64],
    ) -> impl Iterator<Item = f64> + 'a {
        let own = zones_c[self.zone];
        let measured = &telemetry.zones[self.zone];
        self.terms.iter().map(move |term| {
            telemetry.step_s
                * match *term {
                    Term::Wall(Neighbour::Zone(other)) => zones_c[other] - own,
                    Term::Wall(Neighbour::Boundary(other)) => telemetry.boundaries[other].temperature_c[row] - own,
                    Term::Heat => measured.heat_kw(row, own),
                    Term::Solar => measured.irradiance_kw_per_m2.as_ref().map_or(0.0, |irradiance| irradiance[row]),
                }
        })
    }

    /// The change of temperature in one step without the non-parametric term \[K\].
    pub fn change_k(&self, telemetry: &Telemetry, row: usize, zones_c: &[f64], coefficients: &[f64]) -> f64 {
        self.regressors(telemetry, row, zones_c)
            .zip(coefficients)
            .map(|(regressor, coefficient)| regressor * coefficient)
            .sum()
    }
}

/// A linear regression over segments; every column and the target have one value a row.
#[derive(Debug, Clone)]
pub(super) struct Regression {
    /// Regressors, one vector a coefficient.
    pub columns: Vec<Vec<f64>>,
    /// What they explain: the change of temperature in a step \[K\].
    pub target: Vec<f64>,
    /// Rows of this regression that follow each other at the sampling time.
    pub segments: Vec<Range<usize>>,
    /// The row of the telemetry at which each step starts.
    pub rows: Vec<usize>,
}

impl Regression {
    /// The regression of `model` over the steps within `segments` of the telemetry.
    ///
    /// With a bandwidth \[samples\], target and columns are taken minus their kernel smooths (eq. 2.6 to 2.8), which takes out
    /// whatever varies slowly, the non-parametric term with it. Two deviations from the dissertation: the known disturbance w stays
    /// beside u, because a smoother does not reproduce its steps, and without it the error of b is as large as b;
    /// and the change T(t+1) − T(t) is smoothed as one series, because near the ends of a recording the smoothers of T(t+1)
    /// and T(t) are not each other's shift, and eq. 2.6 would not hold there.
    pub fn new(telemetry: &Telemetry, model: &ZoneModel, segments: &[Range<usize>], bandwidth: Option<f64>) -> Self {
        let mut regression = Self {
            columns: vec![Vec::new(); model.terms.len()],
            target: Vec::new(),
            segments: Vec::new(),
            rows: Vec::new(),
        };
        let smoothed = |series: Vec<f64>| match bandwidth {
            Some(bandwidth) => without_smooth(&series, bandwidth),
            None => series,
        };
        for segment in segments.iter().filter(|segment| segment.len() >= 2) {
            let steps = segment.len() - 1;
            let start = regression.rows.len();
            let temperature = &telemetry.zones[model.zone].temperature_c[segment.clone()];
            regression.target.extend(smoothed(temperature.windows(2).map(|pair| pair[1] - pair[0]).collect()));
            let starts = segment.start..segment.start + steps;
            for (column, series) in regression.columns.iter_mut().zip(term_series(telemetry, model, &starts)) {
                column.extend(smoothed(series));
            }
            regression.rows.extend(segment.start..segment.start + steps);
            regression.segments.push(start..start + steps);
        }
        regression
    }

    /// The residuals: target − Σ column · coefficient.
    pub fn residuals(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut rest = self.target.clone();
        for (column, coefficient) in self.columns.iter().zip(coefficients) {
            rest.iter_mut().zip(column).for_each(|(rest, value)| *rest -= coefficient * value);
        }
        rest
    }
}

/// The regressors of each term over some rows, from measured temperatures.
fn term_series(telemetry: &Telemetry, model: &ZoneModel, rows: &Range<usize>) -> Vec<Vec<f64>> {
    let mut series = vec![Vec::with_capacity(rows.len()); model.terms.len()];
    let mut zones_c = vec![0.0; telemetry.zones.len()];
    for row in rows.clone() {
        for (temperature, zone) in zones_c.iter_mut().zip(&telemetry.zones) {
            *temperature = zone.temperature_c[row];
        }
        for (series, value) in series.iter_mut().zip(model.regressors(telemetry, row, &zones_c)) {
            series.push(value);
        }
    }
    series
}

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
