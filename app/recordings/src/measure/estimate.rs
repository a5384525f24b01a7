//! A number with its interval.

use serde::Serialize;

/// A number with its 95 % interval, by a bootstrap over cars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeasureInterval {
    /// The number.
    pub value: f64,
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
}

/// The nearest-rank quantile of ascending numbers, which must not be empty.
pub(crate) fn nearest_rank(ascending: &[f64], share: f64) -> f64 {
    ascending[(share * (ascending.len() - 1) as f64).round() as usize]
}
