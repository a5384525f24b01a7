//! Settings of the iterative design.

use interplay_common::setting::{self, SettingError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::control::ControlError;
use crate::control::disturbance_estimate::DisturbancePrediction;
use crate::control::uncertainty::UncertaintySettings;
use crate::lifted::Lifted;

/// The largest number of inputs of a day for which the feedback is designed; its matrices have the square of that many entries.
const MOST_UNKNOWNS: usize = 1200;
/// The largest number of temperatures, of zones and walls, for which the matrix inequality is solved. Its time grows with the
/// sixth power of that number: a design of 24 takes some ten seconds.
const MOST_LMI_TEMPERATURES: usize = 24;
/// The largest number of temperatures, of zones and walls, for which the linear certificate is computed.
const MOST_LINEAR_TEMPERATURES: usize = 256;

/// The objective that the design minimises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// The expectation of J, which gives feedback a value.
    #[default]
    Expected,
    /// J of the expected disturbance, as printed. Any feedback is then optimal, and none is used (Y = I).
    Nominal,
}

/// How the optimal causal feedback becomes a stabilising gain K (step 2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Stability {
    /// By the corrected matrix inequality, with a decay rate.
    #[default]
    Lmi,
    /// By a linear programme for positive systems, which scales to many zones; each zone uses its own error and those of
    /// its neighbours.
    Linear,
    /// By least squares; the matrix inequality is used only if the result is not stable.
    LeastSquares,
    /// The initial gain is kept.
    Fixed,
}

/// How feedback and plan share the limits of the inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coordination {
    /// First the feedback, as if there were no limits; then a plan that leaves it room.
    #[default]
    TwoStage,
    /// Both together: a lower cost where limits bind, for several times the computing time.
    Joint,
}

/// How the condition that errors do not grow from day to day (eq. 3.8) is enforced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorGrowth {
    /// Growth has a high cost.
    #[default]
    Soft,
    /// Growth is forbidden: on a harder day no plan exists, and the day before is repeated (Remark 1).
    Hard,
    /// The condition is not enforced.
    Off,
}

/// The event to which the confidence refers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Chance {
    /// Each input on its own (eq. 3.21). The probability that all inputs of a day keep their limits is smaller.
    #[default]
    EachInput,
    /// All inputs of a day together, by Bonferroni's inequality.
    WholeDay,
}

/// Feedforward and feedback designed in turn (chapter 3).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct IterativeSettings {
    /// The objective that the design minimises.
    pub objective: Objective,
    /// How feedback and plan share the limits.
    pub coordination: Coordination,
    /// How the feedback is made stabilising.
    pub stability: Stability,
    /// Decay rate r of the closed loop per step that is certified. It must be above the rate at which walls settle between
    /// zones whose temperatures are held, which no feedback changes. By default 0.7, or a fifth of the way from that rate to 1
    /// if that is more.
    #[schemars(range(min = 0.001, max = 1.0), example = 0.7, extend("x-unit" = "dimensionless"))]
    pub decay: Option<f64>,
    /// K of the first day, and of all days with `stability = "fixed"`, as a multiple of the identity \[kW/K\].
    #[schemars(range(min = 0.0))]
    pub initial_gain_kw_per_k: f64,
    /// Share by which capacities and resistances of the model may be wrong: the gain is halved until it is stable for all of them.
    /// With 0 nothing is checked beforehand; inputs that alternate weaken a gain of `lmi` or `linear` in any case.
    #[schemars(range(min = 0.0, max = 2.0), extend("x-unit" = "dimensionless"))]
    pub model_error: f64,
    /// η: how likely inputs stay within their limits.
    #[schemars(range(min = 0.5, max = 0.999999), extend("x-unit" = "dimensionless"))]
    pub confidence: f64,
    /// The event to which the confidence refers.
    pub chance: Chance,
    /// How the condition that errors do not grow from day to day (eq. 3.8) is enforced.
    pub convergence: ErrorGrowth,
    /// Learning rate λ of the bias: the share of a day's prediction error that the bias takes up.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub learning_rate: f64,
    /// What the disturbance is predicted from.
    pub prediction: DisturbancePrediction,
    /// How uncertain the prediction is.
    pub uncertainty: UncertaintySettings,
}

impl Default for IterativeSettings {
    fn default() -> Self {
        Self {
            objective: Objective::default(),
            coordination: Coordination::default(),
            stability: Stability::default(),
            decay: None,
            initial_gain_kw_per_k: 0.1,
            model_error: 0.0,
            confidence: 0.95,
            chance: Chance::default(),
            convergence: ErrorGrowth::default(),
            learning_rate: 0.5,
            prediction: DisturbancePrediction::default(),
            uncertainty: UncertaintySettings::default(),
        }
    }
}

impl IterativeSettings {
    /// Refuses settings that are out of range.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        setting::check(self)
    }

    /// Refuses a building that is too large for dense matrices.
    pub(super) fn check_size(&self, lifted: &Lifted) -> Result<(), ControlError> {
        let (found, most) = (lifted.size(), MOST_UNKNOWNS);
        if found > most {
            return Err(ControlError::TooManyUnknowns { design: "iterative", found, most });
        }
        let (nodes, zones) = (lifted.model().network().node_count(), lifted.zones());
        let (certificate, most, remedy) = match self.stability {
            Stability::Lmi | Stability::LeastSquares => {
                ("the matrix inequality", MOST_LMI_TEMPERATURES, "set `stability = \"linear\"`")
            }
            Stability::Linear => ("the linear certificate", MOST_LINEAR_TEMPERATURES, "use the distributed design"),
            Stability::Fixed => return Ok(()),
        };
        if nodes > most {
            return Err(ControlError::TooManyTemperatures { certificate, remedy, zones, nodes, most });
        }
        Ok(())
    }
}
