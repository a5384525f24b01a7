//! Settings of the concurrent design.

use interplay_common::setting::{self, SettingError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::control::BandPenalty;
use crate::control::disturbance_estimate::DisturbancePrediction;
use crate::control::uncertainty::UncertaintySettings;

/// Feedforward and a Youla-parametrised feedback (chapter 4).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ConcurrentSettings {
    /// Number of taps of the Youla filter Q.
    #[schemars(range(min = 1, max = 48))]
    pub taps: usize,
    /// γ_q: the largest sum of magnitudes in a row of the taps \[kW/K\] (eq. 4.27).
    #[schemars(range(min = 0.0), extend("x-unit" = "kW/K"))]
    pub gamma_q: f64,
    /// γ₂: the largest Frobenius norm of the response to an impulse of heat in each zone \[K/kW\] (eq. 4.12).
    /// Its floor, what an impulse does before anybody can answer, grows with the root of the number of zones; without a
    /// number, the bound is 1.28 times that, 4.6 for the testbed, or more where no taps within γ_q reach it.
    #[schemars(range(min = 0.0), example = 4.6, extend("x-unit" = "K/kW"))]
    pub gamma_2: Option<f64>,
    /// η: how likely inputs and temperatures stay within their bounds, each on its own.
    #[schemars(range(min = 0.5, max = 0.999999), extend("x-unit" = "dimensionless"))]
    pub confidence: f64,
    /// Cost of a kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K"))]
    pub discomfort_linear: f64,
    /// Cost of a squared kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub discomfort_quadratic: f64,
    /// Feedback gain K of the first day, as a multiple of the identity \[kW/K\].
    #[schemars(range(min = 0.0))]
    pub initial_gain_kw_per_k: f64,
    /// Learning rate λ of the bias: the share of a day's prediction error that the bias takes up.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub learning_rate: f64,
    /// What the disturbance is predicted from.
    pub prediction: DisturbancePrediction,
    /// How uncertain the prediction is.
    pub uncertainty: UncertaintySettings,
}

impl Default for ConcurrentSettings {
    fn default() -> Self {
        Self {
            taps: 4,
            gamma_q: 2.5,
            gamma_2: None,
            confidence: 0.95,
            discomfort_linear: 50.0,
            discomfort_quadratic: 50.0,
            initial_gain_kw_per_k: 0.1,
            learning_rate: 0.5,
            prediction: DisturbancePrediction::default(),
            uncertainty: UncertaintySettings::default(),
        }
    }
}

impl ConcurrentSettings {
    /// Refuses settings that are out of range. Bounds below their floor are found when the building is known.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        setting::check(self)
    }

    /// Cost of leaving the comfort band.
    pub(super) fn penalty(&self) -> BandPenalty {
        BandPenalty { linear: self.discomfort_linear, quadratic: self.discomfort_quadratic }
    }
}
