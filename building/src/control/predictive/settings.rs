//! Settings of the model predictive controller.

use interplay_common::setting::{self, SettingError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::control::BandPenalty;

/// Model predictive control: a new plan at every step, from what is measured and forecast.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PredictiveSettings {
    /// How far each plan looks ahead \[h\]. Beyond midnight the targets and the forecast of today are taken once more.
    #[schemars(range(min = 0.25, max = 48.0))]
    pub horizon_h: f64,
    /// Cost of a kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K"))]
    pub discomfort_linear: f64,
    /// Cost of a squared kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub discomfort_quadratic: f64,
    /// λ: the share of a step's unexplained heat that is expected to go on.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub learning_rate: f64,
}

impl Default for PredictiveSettings {
    /// Half a day, and the weights of the concurrent design.
    fn default() -> Self {
        Self { horizon_h: 12.0, discomfort_linear: 50.0, discomfort_quadratic: 50.0, learning_rate: 0.3 }
    }
}

impl PredictiveSettings {
    /// Refuses settings that are out of range.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        setting::check(self)
    }

    /// The number of steps of `step_s` in a plan, at least one.
    pub fn horizon(&self, step_s: f64) -> usize {
        ((self.horizon_h * 3600.0 / step_s).round() as usize).max(1)
    }

    /// Cost of leaving the comfort band.
    pub(super) fn penalty(&self) -> BandPenalty {
        BandPenalty { linear: self.discomfort_linear, quadratic: self.discomfort_quadratic }
    }
}
