//! Settings of an identification.

use std::ops::Range;

use interplay_common::bounds::Bound;
use interplay_common::setting::{self, SettingError, check_bound};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::telemetry::Telemetry;
use crate::discretise;

/// The settings of an identification. Every field has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct IdentifySettings {
    /// The estimator.
    pub method: Estimator,
    /// The most temperatures that `state-space` gives a zone: the measured one, and hidden ones of walls, furniture or heater.
    #[schemars(range(min = 1, max = 3))]
    pub most_states: usize,
    /// Which kinds of hidden temperatures `state-space` tries. Leave out those that the building has not: a heater without mass, such
    /// as a fan heater, has no temperature.
    #[schemars(example = vec!["wall", "interior"])]
    pub hidden: Vec<HiddenTemperature>,
    /// Bandwidth of the kernel smoother \[h\]; only `semiparametric` uses it. Wider ones let slow disturbances bias the
    /// conductances, narrower ones leave only sensor noise.
    #[schemars(range(max = 168.0))]
    pub bandwidth_h: f64,
    /// How a step is understood when rates become capacities and time constants: `exact` for measured buildings, which do
    /// not live in steps; `euler` for data simulated by eq. 2.3 itself. `state-space` is always exact.
    pub discretisation: discretise::Discretisation,
    /// Autoregressive order r of the residual model.
    #[schemars(range(min = 1, max = 10))]
    pub autoregressive_order: usize,
    /// How many daily harmonics the residual model and `prediction-error` hold.
    #[schemars(range(max = 12))]
    pub harmonics: usize,
    /// How long the model runs freely from a measured state, to see how it errs \[h\].
    #[schemars(range(max = 720.0))]
    pub horizon_h: f64,
    /// The first this many days are trained on and the others tested; all are trained on if it is left out.
    #[schemars(range(min = 0.001, max = 100000.0))]
    pub train_days: Option<f64>,
    /// The most time of one core that the search of `state-space` may take, as far as that is known beforehand \[s\].
    #[schemars(range(min = 0.001, max = 10000000.0))]
    pub processor_s: f64,
}

impl Default for IdentifySettings {
    fn default() -> Self {
        Self {
            method: Estimator::StateSpace,
            most_states: 3,
            hidden: vec![HiddenTemperature::Wall, HiddenTemperature::Interior, HiddenTemperature::Heater],
            bandwidth_h: 1.25,
            discretisation: discretise::Discretisation::Exact,
            autoregressive_order: 2,
            harmonics: 3,
            horizon_h: 24.0,
            train_days: None,
            processor_s: 3600.0,
        }
    }
}

/// An estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Estimator {
    /// The dissertation's: kernel smoothing takes out the non-parametric term, least squares finds the parameters, and an ARMA
    /// model is fitted to what is left.
    Semiparametric,
    /// Parameters, daily harmonics and ARMA errors at once, so that the one-step prediction error is smallest. Copes better
    /// with disturbances and sensor noise, and states its uncertainty more truly.
    PredictionError,
    /// Networks with hidden temperatures, by maximum likelihood with a Kalman filter. The only one that knows walls and
    /// furniture with a temperature of their own, as ordinary buildings have.
    #[default]
    StateSpace,
}

/// A kind of hidden temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HiddenTemperature {
    /// The temperature of the mass in a wall to a boundary.
    Wall,
    /// The temperature of a mass that exchanges heat with the air alone: furniture, floors, inner walls.
    Interior,
    /// The temperature of the heater, through which the heat comes.
    Heater,
}

impl IdentifySettings {
    /// Steps of a free run, for a sampling time.
    pub(super) fn horizon_steps(&self, step_s: f64) -> usize {
        libm::round(self.horizon_h * 3600.0 / step_s) as usize
    }

    /// # Errors
    /// [`SettingError`] for the first field that makes no sense with this sampling time.
    pub(super) fn check(&self, step_s: f64) -> Result<(), SettingError> {
        setting::check(self)?;
        let step_h = step_s / 3600.0;
        if self.method == Estimator::StateSpace {
            return check_bound("horizon_h", self.horizon_h, Bound::AtLeast(step_h));
        }
        check_bound("bandwidth_h", self.bandwidth_h, Bound::AtLeast(step_h))?;
        // The highest harmonic must turn slower than the sampling: at most a quarter of the samples a day.
        check_bound("harmonics", self.harmonics as f64, Bound::AtMost((21_600.0 / step_s).floor()))?;
        check_bound("horizon_h", self.horizon_h, Bound::AtLeast(step_h))
    }
}

/// Rows to train and to test on, as segments without a gap.
pub(super) struct TrainTestSplit {
    pub train: Vec<Range<usize>>,
    pub test: Vec<Range<usize>>,
    /// The first row that is not trained on.
    pub test_start: usize,
}

impl TrainTestSplit {
    /// The split after the `train_days` of the settings.
    pub fn new(telemetry: &Telemetry, settings: &IdentifySettings) -> Self {
        let limit = settings.train_days.zip(telemetry.time_s.first());
        let test_start = limit.map_or(telemetry.rows(), |(days, first)| {
            let end_s = first + days * 86_400.0;
            telemetry.time_s.iter().position(|&time| time >= end_s).unwrap_or(telemetry.rows())
        });
        let (train, test) = telemetry.split_at(test_start);
        Self { train, test, test_start }
    }
}
