//! Autoregressive moving-average models of the residuals of the network, eq. 2.12 with a coefficient on the moving average:
//!
//! ```text
//! q_t = z_tᵀβ + v_t,    v_t = Σ_{k=1..r} α_k v_{t−k} + e_t + μ e_{t−1},    e_t white
//! ```
//!
//! z contains the quantities that are known beforehand (a constant, daily harmonics, the zone model's regressors). The
//! printed form, with a constant ψ instead of zᵀβ, is this one with ψ = β (1 − Σα).
//!
//! The printed M-step (2.14) divides by Σq where Σq² belongs, and even then estimates an autoregression, which is biased
//! when there is a moving average. [`fit()`] minimises the conditional sum of squares Σ e_t² instead.

mod fit;
#[cfg(test)]
mod tests;

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;

pub(super) use fit::fit;

/// An ARMA(r,1) model of a series without mean.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Arma {
    /// α_1 … α_r.
    pub autoregressive: Vec<f64>,
    /// μ.
    pub moving_average: f64,
    /// Standard deviation of the innovations e \[unit of the series\].
    pub innovation_sd: f64,
}

impl Arma {
    /// The innovations e_t of a series; zero for the first r of each segment, on which the others are conditioned.
    pub fn innovations(&self, series: &[f64], segments: &[Range<usize>]) -> Vec<f64> {
        whitened(series, &self.autoregressive, self.moving_average, segments)
    }

    /// The expected values of v_t, v_{t+1}, … given the segment's past values (`past[last]` is v_{t−1}) and e_{t−1}.
    pub fn forecast(&self, past: &[f64], last_innovation: f64, horizon: usize) -> Vec<f64> {
        let mut values: Vec<f64> = past[past.len().saturating_sub(self.autoregressive.len())..].to_vec();
        let start = values.len();
        for ahead in 0..horizon {
            let recursion: f64 = self.autoregressive.iter().zip(values.iter().rev()).map(|(alpha, v)| alpha * v).sum();
            values.push(recursion + if ahead == 0 { self.moving_average * last_innovation } else { 0.0 });
        }
        values.split_off(start)
    }
}

/// w_t = x_t − Σ α_k x_{t−k} − μ w_{t−1} over each segment, and zero for its first r rows.
fn whitened(series: &[f64], autoregressive: &[f64], moving_average: f64, segments: &[Range<usize>]) -> Vec<f64> {
    let order = autoregressive.len();
    let input = |t: usize| {
        let past: f64 = autoregressive.iter().enumerate().map(|(k, alpha)| alpha * series[t - 1 - k]).sum();
        series[t] - past
    };
    moving_average_inverted(input, order, moving_average, segments, series.len())
}

/// w_t = input(t) − μ w_{t−1} over each segment from its row `skip` on, and zero before.
fn moving_average_inverted(
    input: impl Fn(usize) -> f64,
    skip: usize,
    moving_average: f64,
    segments: &[Range<usize>],
    rows: usize,
) -> Vec<f64> {
    let mut output = vec![0.0; rows];
    for segment in segments {
        let mut before = 0.0;
        for t in segment.start + skip..segment.end {
            before = input(t) - moving_average * before;
            output[t] = before;
        }
    }
    output
}

/// Largest magnitude of a reflection coefficient that is accepted as stable. At 1 the autoregression is unstable; with one
/// coefficient of this value a disturbance decays by a factor e within 10,000 steps.
const MAX_REFLECTION: f64 = 0.9999;

/// Whether the autoregression is stable, by the step-down recursion: its reflection coefficients are below one.
pub(super) fn is_stable(autoregressive: &[f64]) -> bool {
    let mut coefficients = autoregressive.to_vec();
    while let Some(reflection) = coefficients.pop() {
        if reflection.is_nan() || reflection.abs() > MAX_REFLECTION {
            return false;
        }
        let scale = 1.0 / (1.0 - reflection * reflection);
        let reversed: Vec<f64> = coefficients.iter().rev().copied().collect();
        for (coefficient, mirror) in coefficients.iter_mut().zip(reversed) {
            *coefficient = (*coefficient + reflection * mirror) * scale;
        }
    }
    true
}

#[cfg(test)]
mod stability_tests {
    use proptest::prelude::*;

    use super::is_stable;

    proptest! {
        /// A second-order autoregression is stable within a triangle.
        #[test]
        fn a_second_order_autoregression_is_stable_within_the_known_triangle(a1 in -2.5..2.5, a2 in -1.5..1.5) {
            let margin: f64 = [1.0 - a2 - a1, 1.0 - a2 + a1, 1.0 + a2].into_iter().fold(f64::MAX, f64::min);
            prop_assume!(margin.abs() > 1e-3);
            prop_assert_eq!(is_stable(&[a1, a2]), margin > 0.0);
        }

        /// Third order, made from its roots.
        #[test]
        fn a_third_order_autoregression_is_stable_if_its_roots_are_inside_the_unit_circle(p in -1.3..1.3, q in -1.3..1.3, s in -1.3..1.3) {
            prop_assume!([p, q, s].iter().all(|root: &f64| (root.abs() - 1.0).abs() > 1e-2));
            let alpha: [f64; 3] = [p + q + s, -(p * q + q * s + p * s), p * q * s];
            prop_assert_eq!(is_stable(&alpha), [p, q, s].iter().all(|root: &f64| root.abs() < 1.0));
        }
    }
}
