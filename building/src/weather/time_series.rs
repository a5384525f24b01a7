//! A quantity at equal intervals of time, interpolated linearly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Values at `first_s`, `first_s + interval_s`, …
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimeSeries {
    /// Time of the first value \[s\].
    pub first_s: f64,
    /// Time between two values \[s\].
    pub interval_s: f64,
    /// Whether the values begin anew after the last, as those of a year do.
    pub cyclic: bool,
    /// The values; at least one.
    pub values: Vec<f64>,
}

impl TimeSeries {
    /// The value at a time, interpolated linearly. Beyond the ends of a series that is not cyclic, the value at the nearer end holds.
    ///
    /// # Panics
    /// When there are no values.
    pub fn at(&self, time_s: f64) -> f64 {
        let count = self.values.len();
        assert!(count > 0, "a series needs a value");
        let last = (count - 1) as f64;
        let position = (time_s - self.first_s) / self.interval_s;
        let position = if self.cyclic { position.rem_euclid(count as f64) } else { position.clamp(0.0, last) };
        // Rounding can lift a position just below zero to `count` itself.
        let before = (position.floor() as usize).min(count - 1);
        let after = if self.cyclic { (before + 1) % count } else { (before + 1).min(count - 1) };
        let part = position - before as f64;
        self.values[before] + part * (self.values[after] - self.values[before])
    }

    /// The time until which the last value holds: one interval after its own time \[s\].
    pub fn end_s(&self) -> f64 {
        self.first_s + self.values.len() as f64 * self.interval_s
    }

    /// The arithmetic mean of the values.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }
}
