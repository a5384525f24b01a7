//! A number with its interval.

use serde::Serialize;

/// A number with its interval at 95 %, by a bootstrap over cars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeasureInterval {
    /// The number.
    pub value: f64,
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
}
