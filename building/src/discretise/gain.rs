//! The effect of a steady kilowatt into each node on all temperatures within one step: a symmetric matrix \[K/kW\],
//! stored in one of three forms.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::spectrum::{Spectrum, inverse_root, rate_bound_per_s};
use crate::network::Network;

/// A symmetric positive definite matrix f(C⁻¹L)·C⁻¹.
#[derive(Clone, Debug)]
pub(crate) enum Gain {
    /// Its diagonal, for f constant.
    Diagonal(Vec<f64>),
    /// All of it.
    Dense(DMatrix<f64>),
    /// A polynomial in the Laplacian.
    Series(ChebyshevSeries),
}

/// f(C⁻¹L)·C⁻¹ as a Chebyshev series in S = C^-½ L C^-½, whose spectrum lies in [0, ρ]:
///
/// ```text
/// C^-½ Σₖ aₖ Tₖ(2S/ρ − I) C^-½
/// ```
#[derive(Clone, Debug)]
pub(crate) struct ChebyshevSeries {
    coefficients: Vec<f64>,
    inverse_root: Vec<f64>,
    bound_per_s: f64,
}

impl Gain {
    /// f(C⁻¹L)·C⁻¹ from the modes.
    pub(super) fn dense(spectrum: &Spectrum, f: impl Fn(f64) -> f64) -> Self {
        Self::Dense(spectrum.function(f))
    }

    /// f(C⁻¹L)·C⁻¹ as a series, without a matrix; `f` must be analytic around \[0, ∞).
    pub(super) fn series(network: &Network, f: impl Fn(f64) -> f64) -> Self {
        // A network without any conductance has the spectrum {0}; then any interval is valid.
        let bound_per_s = rate_bound_per_s(network).max(f64::MIN_POSITIVE.sqrt());
        let coefficients = chebyshev(|x| f(0.5 * bound_per_s * (x + 1.0)));
        Self::Series(ChebyshevSeries { coefficients, inverse_root: inverse_root(network), bound_per_s })
    }

    /// The product with one number per node.
    pub(super) fn product(&self, network: &Network, x: &[f64]) -> Vec<f64> {
        match self {
            Self::Diagonal(diagonal) => diagonal.iter().zip(x).map(|(d, x)| d * x).collect(),
            Self::Dense(matrix) => {
                let mut out = DVector::zeros(x.len());
                for (column, x) in matrix.column_iter().zip(x) {
                    out.axpy(*x, &column, 1.0);
                }
                out.data.into()
            }
            Self::Series(series) => series.product(network, x),
        }
    }
}

impl ChebyshevSeries {
    /// Clenshaw would run backwards over the coefficients with the same cost; forwards reads like the definition.
    fn product(&self, network: &Network, x: &[f64]) -> Vec<f64> {
        let mut before: Vec<f64> = x.iter().zip(&self.inverse_root).map(|(x, r)| r * x).collect();
        let mut term = self.shifted(network, &before);
        let mut sum: Vec<f64> = before.iter().map(|before| self.coefficients[0] * before).collect();
        for (degree, coefficient) in self.coefficients.iter().enumerate().skip(1) {
            for (sum, term) in sum.iter_mut().zip(&term) {
                *sum += coefficient * term;
            }
            if degree + 1 < self.coefficients.len() {
                let mut next = self.shifted(network, &term);
                for (next, before) in next.iter_mut().zip(&before) {
                    *next = 2.0 * *next - before;
                }
                before = std::mem::replace(&mut term, next);
            }
        }
        for (sum, r) in sum.iter_mut().zip(&self.inverse_root) {
            *sum *= r;
        }
        sum
    }

    /// (2S/ρ − I) v.
    fn shifted(&self, network: &Network, v: &[f64]) -> Vec<f64> {
        let scaled: Vec<f64> = v.iter().zip(&self.inverse_root).map(|(v, r)| r * v).collect();
        let mut out = network.conduct(&scaled);
        let scale = 2.0 / self.bound_per_s;
        for ((out, r), v) in out.iter_mut().zip(&self.inverse_root).zip(v) {
            *out = scale * r * *out - v;
        }
        out
    }
}

/// Chebyshev coefficients of an analytic function on [−1, 1], to the last digit: the function is interpolated in twice as
/// many points until the last coefficients are rounding errors, and those are left out.
fn chebyshev(f: impl Fn(f64) -> f64) -> Vec<f64> {
    /// Number of points of the first interpolation, and of the last, which is taken as it is. The sums cost the square of it.
    const MIN_POINTS: usize = 16;
    const MAX_POINTS: usize = 1 << 14;
    let mut points = MIN_POINTS;
    loop {
        let coefficients = interpolated(&f, points);
        let largest = coefficients.iter().fold(0.0_f64, |largest, a| largest.max(a.abs()));
        let negligible = 4.0 * f64::EPSILON * largest;
        let needed = coefficients.iter().rposition(|a| a.abs() > negligible).map_or(1, |last| last + 1);
        if needed + points / 8 <= points || points >= MAX_POINTS {
            return coefficients[..needed].to_vec();
        }
        points *= 2;
    }
}

/// Coefficients of the interpolating polynomial in the zeros of T_m.
fn interpolated(f: impl Fn(f64) -> f64, points: usize) -> Vec<f64> {
    let m = points as f64;
    // The cosines cos(kπ/2m) for all k that the sums need.
    let cosines: Vec<f64> = (0..4 * points).map(|k| libm::cos(PI * k as f64 / (2.0 * m))).collect();
    let values: Vec<f64> = (0..points).map(|j| f(cosines[2 * j + 1])).collect();
    let coefficient = |k: usize| {
        let sum: f64 = values.iter().enumerate().map(|(j, v)| v * cosines[k * (2 * j + 1) % (4 * points)]).sum();
        if k == 0 { sum / m } else { 2.0 * sum / m }
    };
    (0..points).map(coefficient).collect()
}
