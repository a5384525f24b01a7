//! Forecasts of the outdoor temperature of a day.
//!
//! The uncertain forecast is the true temperature plus an error that grows over the horizon, an AR(1) process by the hour,
//! as BOPTEST defines it (Zheng et al.):
//!
//! ```text
//! e(0) ~ N(F₀, K₀²)        e(h+1) ~ N(F e(h) + μ, K²)
//! ```

use interplay_common::random::Random;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{TimeSeries, Weather};

/// How a day's outdoor temperatures are forecast at its start. (For the forecast of a second file, ask that file's
/// weather for [`Forecast::Exact`].)
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Forecast {
    /// The forecast has no error.
    #[default]
    Exact,
    /// The forecast has a random error as BOPTEST defines it.
    Uncertain {
        /// Size of the error.
        #[schemars(example = &"low")]
        level: ErrorLevel,
    },
    /// The forecast is the weather of the day before.
    Persistence,
}

/// Sizes of the forecast error that BOPTEST defines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorLevel {
    /// Standard deviation 0.6 K at first, 1.0 K later.
    Low,
    /// Standard deviation 1.2 K at first, 1.6 K later.
    #[default]
    Medium,
    /// Standard deviation 1.5 K at first, 2.2 K later, and too cold on average.
    High,
}

/// Parameters of the forecast error, an autoregressive process of first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorModel {
    /// Mean of the first error, F₀ \[K\].
    pub first_mean_k: f64,
    /// Standard deviation of the first error, K₀ \[K\].
    pub first_deviation_k: f64,
    /// Share of an error that is left an hour later, F.
    pub correlation: f64,
    /// Drift that is added each hour, μ \[K\].
    pub drift_k: f64,
    /// Standard deviation of what is new each hour, K \[K\].
    pub deviation_k: f64,
}

impl ErrorLevel {
    /// The parameters of the level.
    pub fn model(self) -> ErrorModel {
        let (first_mean_k, first_deviation_k, correlation, drift_k, deviation_k) = match self {
            Self::Low => (0.0, 0.6, 0.92, 0.0, 0.4),
            Self::Medium => (0.15, 1.2, 0.93, 0.0, 0.6),
            Self::High => (-0.58, 1.5, 0.95, -0.015, 0.7),
        };
        ErrorModel { first_mean_k, first_deviation_k, correlation, drift_k, deviation_k }
    }
}

impl ErrorModel {
    /// Forecast errors at the full hours of a horizon, beginning with its start \[K\].
    pub fn errors_k(&self, seed: u64, day: usize, hours: usize) -> Vec<f64> {
        let mut random = Random::new(seed, day as u64);
        let mut error_k = random.normal(self.first_mean_k, self.first_deviation_k);
        let mut errors_k = vec![error_k];
        for _ in 0..hours {
            error_k = random.normal(self.correlation * error_k + self.drift_k, self.deviation_k);
            errors_k.push(error_k);
        }
        errors_k
    }
}

impl Forecast {
    /// The outdoor temperatures of a day's steps as forecast at its midnight \[°C\], to be compared with
    /// [`Weather::ambient_steps_c`]. Each day of a seed has its own errors; between full hours they are linear.
    pub fn ambient_steps_c(&self, actual: &Weather, seed: u64, day: usize, step_s: f64, steps: usize) -> Vec<f64> {
        const DAY_S: f64 = 86_400.0;
        let start_s = day as f64 * DAY_S;
        match self {
            Self::Exact => actual.ambient_steps_c(start_s, step_s, steps),
            Self::Persistence => actual.ambient_steps_c(start_s - DAY_S, step_s, steps),
            Self::Uncertain { level } => {
                let hours = (steps as f64 * step_s / 3600.0).ceil() as usize;
                let values = level.model().errors_k(seed, day, hours);
                let error_k = TimeSeries { first_s: 0.0, interval_s: 3600.0, cyclic: false, values };
                let mut forecast_c = actual.ambient_steps_c(start_s, step_s, steps);
                for (step, forecast_c) in forecast_c.iter_mut().enumerate() {
                    *forecast_c += error_k.at((step as f64 + 0.5) * step_s);
                }
                forecast_c
            }
        }
    }
}
