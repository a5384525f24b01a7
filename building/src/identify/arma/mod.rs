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
mod stability;
#[cfg(test)]
mod tests;

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;

pub(super) use fit::fit;
pub(super) use stability::is_stable;

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
