//! What earlier days taught of the disturbance.
//!
//! After day k the temperatures tell what acted besides the equipment, as zone heat:
//!
//! ```text
//! D_k = G⁻¹ (T_k − T_in) − U_k            bias ← (1 − λ) bias + λ (D_k − D̂_k)
//! D̂_k+1 + bias                            is what day k + 1 is planned with
//! ```
//!
//! The source plans with D̂_k+1 alone and so learns nothing. The forecast is not turned into zone heat: its effect is
//! simulated, and D_k − D̂_k = G⁻¹ (T_k − T_free) − U_k with T_free under the forecast.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ControlError, DayRecord, Morning};
use crate::lifted::Lifted;
use crate::setting::check_within;

/// What the disturbance of a day is predicted from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Prediction {
    /// The forecast, corrected by the bias of earlier days.
    #[default]
    Forecast,
    /// The day before repeats itself; the forecast is not looked at.
    Yesterday,
}

/// Memory of disturbances.
#[derive(Clone, Debug)]
pub struct Experience {
    lifted: Lifted,
    prediction: Prediction,
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

/// What a day was like.
#[derive(Clone, Debug, PartialEq)]
pub struct Lesson {
    /// D_k − (D̂_k + bias): what the best prediction missed \[kW\], stacked.
    pub surprise_kw: Vec<f64>,
}

impl Experience {
    /// No experience. `rate` is λ.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if the rate is not between 0 and 1.
    pub fn new(lifted: Lifted, prediction: Prediction, rate: f64) -> Result<Self, ControlError> {
        check_within("learning_rate", rate, 0.0..=1.0, "between 0 and 1")?;
        let bias_kw = vec![0.0; lifted.size()];
        Ok(Self { lifted, prediction, rate, bias_kw, measured_kw: None, today: None })
    }

    /// The model of a day.
    pub fn lifted(&self) -> &Lifted {
        &self.lifted
    }

    /// Heat beyond the forecast that is believed to return \[kW\], stacked.
    pub fn bias_kw(&self) -> &[f64] {
        &self.bias_kw
    }

    /// Whether there was a day to learn from.
    pub fn is_empty(&self) -> bool {
        self.measured_kw.is_none()
    }

    /// Temperatures without equipment to plan with \[°C\], stacked.
    ///
    /// # Errors
    /// [`ControlError::NotFinite`] if the forecast or a temperature is no number; nothing is learned from such a day.
    pub fn expect(&mut self, morning: &Morning<'_>) -> Result<Vec<f64>, ControlError> {
        self.today = None;
        ControlError::check_finite("the temperatures at midnight", morning.initial_c)?;
        morning.forecast.check_finite()?;
        let (steps, size) = (self.lifted.steps(), self.lifted.size());
        let undisturbed_c = self.lifted.free_response(morning.initial_c, &vec![0.0; steps], &vec![0.0; size]);
        let forecast = morning.forecast;
        let forecast_c = self.lifted.free_response(morning.initial_c, &forecast.ambient_c, &forecast.gains_kw);
        let expected_c = match (self.prediction, &self.measured_kw) {
            (Prediction::Yesterday, Some(measured_kw)) => add(&undisturbed_c, &self.lifted.product(measured_kw)),
            _ => add(&forecast_c, &self.lifted.product(&self.bias_kw)),
        };
        self.today = Some(Today { undisturbed_c, forecast_c });
        Ok(expected_c)
    }

    /// Learns from a day. Nothing is learned, and nothing returned, if the day had no forecast or the record has a number
    /// that is none.
    ///
    /// # Errors
    /// [`ControlError::Shape`] if the record is of another day or building.
    pub fn learn(&mut self, record: &DayRecord) -> Result<Option<Lesson>, ControlError> {
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
        let surprise_kw = missed_kw.iter().zip(&self.bias_kw).map(|(missed, bias)| missed - bias).collect();
        for (bias_kw, missed_kw) in self.bias_kw.iter_mut().zip(&missed_kw) {
            *bias_kw = (1.0 - self.rate) * *bias_kw + self.rate * missed_kw;
        }
        self.measured_kw = Some(measured_kw);
        Ok(Some(Lesson { surprise_kw }))
    }
}

fn add(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}
