//! Standard errors that hold where the innovations are not white: the sandwich I⁻¹ J I⁻¹, with the long-run variance J of the rows'
//! scores in place of the information (Newey and West, *Econometrica* 55, 1987).
//!
//! ```text
//! Var f = dᵀ J d,   d = I⁻¹ ∇f;       aₜ = d · ∂ℓₜ,   dᵀ J d = Σ aₜ² + 2 Σ_l (1 − l/(L+1)) Σ aₜ aₜ₋ₗ
//! ```

use std::ops::Range;

use super::likelihood::{Observations, scores};
use super::selection::Fit;

/// Correlations of scores count up to this lag \[s\] …
const LONGEST_LAG_S: f64 = 12.0 * 3600.0;
/// … and up to this share of the rows.
const LONGEST_LAG_SHARE: usize = 20;

/// The scores of a fit.
pub(super) struct Sandwich {
    scores: Vec<f64>,
    parameters: usize,
    segments: Vec<Range<usize>>,
    lags: usize,
}

impl Sandwich {
    /// Computes the matrices of the sandwich; `None` if the model has no likelihood.
    pub fn new(fit: &Fit, observations: &Observations) -> Option<Self> {
        let model = |theta: &[super::exponential::Number]| fit.structure.model(theta);
        let rows: usize = observations.segments.iter().map(Range::len).sum();
        let lags = (LONGEST_LAG_S / observations.step_s) as usize;
        Some(Self {
            scores: scores(&model, &fit.maximum.theta, observations)?,
            parameters: fit.maximum.theta.len(),
            segments: observations.segments.clone(),
            lags: lags.min(rows / LONGEST_LAG_SHARE),
        })
    }

    /// Standard error of a function of the parameters, from its `direction` I⁻¹ ∇f.
    pub fn standard_error(&self, direction: &[f64]) -> f64 {
        let along: Vec<f64> = self
            .scores
            .chunks_exact(self.parameters)
            .map(|scores| scores.iter().zip(direction).map(|(score, weight)| score * weight).sum())
            .collect();
        let product = |lag: usize| -> f64 {
            let of_segment = |segment: &Range<usize>| -> f64 {
                (segment.start + lag..segment.end).map(|row| along[row] * along[row - lag]).sum()
            };
            self.segments.iter().map(of_segment).sum()
        };
        let weight = |lag: usize| 2.0 * (1.0 - lag as f64 / (self.lags + 1) as f64);
        let correlated: f64 = (1..=self.lags).map(|lag| weight(lag) * product(lag)).sum();
        libm::sqrt((product(0) + correlated).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scores that come in equal pairs have twice the long-run variance of white ones; Bartlett's weights see half of that at L = 1.
    #[test]
    fn correlated_scores_have_larger_standard_errors() {
        let sign = |row: usize| if (row / 2 * 7919) % 13 < 6 { 1.0 } else { -1.0 };
        let scores: Vec<f64> = (0..400).map(sign).collect();
        let of = |lags| Sandwich {
            scores: scores.clone(),
            parameters: 1,
            segments: std::iter::once(0..400).collect(),
            lags,
        };
        let white = of(0).standard_error(&[1.0]);
        assert!((white - 20.0).abs() < 1e-12);
        assert!(of(1).standard_error(&[1.0]) > 1.15 * white);
    }
}
