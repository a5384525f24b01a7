//! The expected disturbance, corrected by measurements of earlier days.
//!
//! After day k, the temperatures T_k and inputs U_k determine the disturbance D_k, expressed as zone heat:
//!
//! ```text
//! D_k = G⁻¹ (T_k − T_in) − U_k            bias ← (1 − λ) bias + λ (D_k − D̂_k)
//! D̂_k+1 + bias                            the prediction for day k + 1
//! ```
//!
//! The dissertation plans with D̂_k+1 alone and so learns nothing. The forecast itself need not be expressed as zone heat: its
//! effect is simulated, and D_k − D̂_k = G⁻¹ (T_k − T_free) − U_k with T_free under the forecast.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ControlError, DayAhead, DayRecord};
use crate::lifted::Lifted;

/// What the disturbance of a day is predicted from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DisturbancePrediction {
    /// The forecast, corrected by the bias of earlier days.
    #[default]
    Forecast,
    /// The disturbance of the day before; the forecast is not used.
    Yesterday,
}

impl DisturbancePrediction {
    /// The key and the reason because of which all days must have the same people; `None` if weekdays may differ.
    pub(super) fn needs_equal_days(self) -> Option<(&'static str, &'static str)> {
        let why = "the disturbance of a day is expected to be that of the day before";
        (self == Self::Yesterday).then_some(("prediction", why))
    }
}

/// Estimates the disturbance of the next day from the forecast and from earlier days.
#[derive(Clone, Debug)]
pub struct DisturbanceEstimator {
    lifted: Lifted,
    prediction: DisturbancePrediction,
    rate: f64,
    bias_kw: Vec<f64>,
    /// D_k of the day before.
    measured_kw: Option<Vec<f64>>,
    today: Option<Today>,
}

#[derive(Clone, Debug)]
struct Today {
    /// Temperatures of the zones without equipment or disturbance.
    undisturbed_c: Vec<f64>,
    /// The same under the forecast.
    forecast_c: Vec<f64>,
}

/// The error of a day's predicted disturbance.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictionError {
    /// The measured disturbance minus the prediction, D_k − (D̂_k + bias) \[kW\], stacked.
    pub error_kw: Vec<f64>,
}

impl DisturbanceEstimator {
    /// An estimator before the first day. `rate` is λ, between 0 and 1.
    pub fn new(lifted: Lifted, prediction: DisturbancePrediction, rate: f64) -> Self {
        let bias_kw = vec![0.0; lifted.size()];
        Self { lifted, prediction, rate, bias_kw, measured_kw: None, today: None }
    }

    /// The lifted model of a day.
    pub fn lifted(&self) -> &Lifted {
        &self.lifted
    }

    /// The bias of the forecast \[kW\], stacked.
    pub fn bias_kw(&self) -> &[f64] {
        &self.bias_kw
    }

    /// Whether no day has been learned from yet.
    pub fn is_empty(&self) -> bool {
        self.measured_kw.is_none()
    }

    /// The zone temperatures that are predicted for a day without equipment \[°C\], stacked.
    ///
    /// # Errors
    /// [`ControlError::NotFinite`] if the forecast or a temperature is not finite; nothing is learned from such a day.
    pub fn expect(&mut self, day_ahead: &DayAhead<'_>) -> Result<Vec<f64>, ControlError> {
        self.today = None;
        ControlError::check_finite("the temperatures at midnight", day_ahead.initial_c)?;
        day_ahead.forecast.check_finite()?;
        let forecast = day_ahead.forecast;
        let (zero_c, zero_kw) = (vec![0.0; forecast.ambient_c.len()], vec![0.0; forecast.gains_kw.len()]);
        let undisturbed_c = self.lifted.free_response(day_ahead.initial_c, &zero_c, &zero_kw);
        let forecast_c = self.lifted.free_response(day_ahead.initial_c, &forecast.ambient_c, &forecast.gains_kw);
        let expected_c = match (self.prediction, &self.measured_kw) {
            (DisturbancePrediction::Yesterday, Some(measured_kw)) => {
                add(&undisturbed_c, &self.lifted.product(measured_kw))
            }
            _ => add(&forecast_c, &self.lifted.product(&self.bias_kw)),
        };
        self.today = Some(Today { undisturbed_c, forecast_c });
        Ok(expected_c)
    }

    /// Updates the bias after a day, and returns the error of its prediction. Nothing is learned, and `None` returned, if
    /// the day had no forecast or the record holds a number that is not finite.
    ///
    /// # Errors
    /// [`ControlError::Shape`] if the record is of another day or building.
    pub fn learn(&mut self, record: &DayRecord) -> Result<Option<PredictionError>, ControlError> {
        let size = self.lifted.size();
        ControlError::check_length("the day's temperatures", record.temperatures_c.len(), size)?;
        ControlError::check_length("the day's inputs", record.heat_kw.len(), size)?;
        let finite = record.temperatures_c.iter().chain(&record.heat_kw).all(|value| value.is_finite());
        let Some(today) = self.today.take().filter(|_| finite) else { return Ok(None) };
        let explained = |free_c: &[f64]| -> Vec<f64> {
            let risen_k: Vec<f64> = record.temperatures_c.iter().zip(free_c).map(|(t, free)| t - free).collect();
            self.lifted.solve(&risen_k).iter().zip(&record.heat_kw).map(|(all, own)| all - own).collect()
        };
        let measured_kw = explained(&today.undisturbed_c);
        let missed_kw = explained(&today.forecast_c);
        let error_kw = missed_kw.iter().zip(&self.bias_kw).map(|(missed, bias)| missed - bias).collect();
        for (bias_kw, missed_kw) in self.bias_kw.iter_mut().zip(&missed_kw) {
            *bias_kw = (1.0 - self.rate) * *bias_kw + self.rate * missed_kw;
        }
        self.measured_kw = Some(measured_kw);
        Ok(Some(PredictionError { error_kw }))
    }
}

fn add(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}
