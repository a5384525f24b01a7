//! Settings of the distributed design and of its centralised counterpart.

use interplay_common::bounds::Bound;
use interplay_common::setting::{self, SettingError, check_bound};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::control::BandPenalty;
use crate::control::disturbance_estimate::DisturbancePrediction;

/// How the zones' proposals of a round become a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// A share 1/n of each zone's proposal, with n zones (Algorithm 1).
    Jacobi,
    /// A common share of all proposals: the best between 1/n and 1.
    LineSearch,
    /// The best combination of the proposals and the step before.
    #[default]
    Momentum,
}

/// Zones that plan together by exchanging messages with their neighbours (chapter 5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DistributedSettings {
    /// How proposals become a step. Where messages are late, it is always Jacobi's.
    pub scheme: Scheme,
    /// ε: the zones agree when no zone moves its inputs of a day by more than this, in the Euclidean norm \[kW\]; unless the
    /// scheme is Jacobi's, in ten rounds in a row.
    #[schemars(range(min = 0.0))]
    pub tolerance_kw: f64,
    /// k^c_max: rounds after which they stop.
    pub rounds: usize,
    /// Cost of a squared kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub discomfort_quadratic: f64,
    /// Feedback of each zone on its own error \[kW/K\]. A light zone has less: at most its capacity over the step, less its
    /// conductances, so that its error does not change its sign within a step.
    #[schemars(range(min = 0.0))]
    pub gain_kw_per_k: f64,
    /// Learning rate λ of the bias: the share of a day's prediction error that the bias takes up.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub learning_rate: f64,
    /// What the disturbance is predicted from.
    pub prediction: DisturbancePrediction,
    /// Share of the messages that are lost, drawn from a generator with a seed of its own. A lost one is sent again in its
    /// round, at most eight times.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub loss: f64,
    /// Number of rounds by which messages are late.
    pub delay_rounds: usize,
    /// A zone that has stopped answering: it keeps its last inputs, and its neighbours keep its last messages.
    /// Zones are numbered from 0.
    #[schemars(example = 0)]
    pub silent_zone: Option<usize>,
    /// Whether the centralised optimum is computed too, for comparison.
    pub compare: bool,
}

impl Default for DistributedSettings {
    fn default() -> Self {
        Self {
            scheme: Scheme::default(),
            tolerance_kw: 1e-3,
            rounds: 200,
            discomfort_quadratic: 50.0,
            gain_kw_per_k: 0.2,
            learning_rate: 0.5,
            prediction: DisturbancePrediction::default(),
            loss: 0.0,
            delay_rounds: 0,
            silent_zone: None,
            compare: false,
        }
    }
}

impl DistributedSettings {
    /// Refuses settings that are out of range.
    pub(super) fn check(&self, zones: usize) -> Result<(), SettingError> {
        setting::check(self)?;
        let last_zone = zones.max(1) as f64 - 1.0;
        self.silent_zone.map_or(Ok(()), |zone| check_bound("silent_zone", zone as f64, Bound::AtMost(last_zone)))
    }
}

/// The day's plan of all zones in one problem (eq. 5.12).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CentralisedSettings {
    /// Cost of a squared kelvin beyond the comfort band, per step.
    #[schemars(range(min = 0.0), extend("x-unit" = "1/K²"))]
    pub discomfort_quadratic: f64,
    /// Feedback of each zone on its own error \[kW/K\].
    #[schemars(range(min = 0.0))]
    pub gain_kw_per_k: f64,
    /// Learning rate λ of the bias: the share of a day's prediction error that the bias takes up.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub learning_rate: f64,
    /// What the disturbance is predicted from.
    pub prediction: DisturbancePrediction,
}

impl Default for CentralisedSettings {
    fn default() -> Self {
        let DistributedSettings { discomfort_quadratic, gain_kw_per_k, learning_rate, prediction, .. } =
            DistributedSettings::default();
        Self { discomfort_quadratic, gain_kw_per_k, learning_rate, prediction }
    }
}

impl CentralisedSettings {
    /// Refuses settings that are out of range.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        setting::check(self)
    }
}

/// Cost of leaving the comfort band.
pub(super) fn penalty(quadratic: f64) -> BandPenalty {
    BandPenalty { linear: 0.0, quadratic }
}
