//! The list of all controllers, with the word that a scenario file uses for each.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clairvoyant::ClairvoyantSettings;
use super::concurrent::ConcurrentSettings;
use super::distributed::{CentralisedSettings, DistributedSettings};
use super::error::ControlError;
use super::iterative::IterativeSettings;
use super::learning::LearningSettings;
use super::pid::PidSettings;
use super::predictive::PredictiveSettings;
use super::regulator::{ControllerKind, Regulator};
use super::thermostat::ThermostatSettings;
use crate::discretise::Model;
use crate::lifted::Lifted;

/// The controller of a building with its settings; `kind` in a scenario file chooses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Controller {
    /// Full power or none, with a dead band.
    Thermostat(ThermostatSettings),
    /// A PID controller per zone.
    Pid(PidSettings),
    /// Plain iterative learning of P- or PD-type on top of a PID controller, with or without a forecast.
    IterativeLearning(LearningSettings),
    /// The cheapest inputs over a horizon, anew at every step.
    ModelPredictive(PredictiveSettings),
    /// The day's optimum, computed from the actual disturbances: for comparison.
    Clairvoyant,
    /// Feedforward and feedback designed in turn, with an expected cost (chapter 3).
    Iterative(IterativeSettings),
    /// Feedforward and a Youla-parametrised feedback (chapter 4).
    Concurrent(ConcurrentSettings),
    /// Zones that plan together by exchanging messages with their neighbours (chapter 5).
    Distributed(DistributedSettings),
    /// The problem of the distributed design, solved centrally (eq. 5.12).
    Centralised(CentralisedSettings),
}

impl Controller {
    fn settings(&self) -> &dyn ControllerKind {
        match self {
            Self::Thermostat(settings) => settings,
            Self::Pid(settings) => settings,
            Self::IterativeLearning(settings) => settings,
            Self::ModelPredictive(settings) => settings,
            Self::Clairvoyant => &ClairvoyantSettings,
            Self::Iterative(settings) => settings,
            Self::Concurrent(settings) => settings,
            Self::Distributed(settings) => settings,
            Self::Centralised(settings) => settings,
        }
    }

    /// The word for this kind of controller in a scenario file.
    pub fn kind(&self) -> &'static str {
        self.settings().kind()
    }

    /// Whether this kind of controller plans each day, and describes the plan in a [`Design`](super::Design).
    pub fn plans(&self) -> bool {
        self.settings().plans()
    }

    /// The key of a setting, and the reason, because of which all days must have the same targets and people; `None` if
    /// weekdays may differ.
    pub fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        self.settings().needs_equal_days()
    }

    /// What to look for in a run with this kind of controller, as the end of a sentence that begins with "Look for:".
    pub fn look_for(&self) -> &'static str {
        self.settings().look_for()
    }

    /// The spectral radius of the map from the errors of one day to those of the next, for equal days and no feedback.
    /// Below 1 the errors vanish in the end. `lifted` is the model of a day.
    ///
    /// Returns `None` if the settings do not determine it: the kind does not learn, or it describes each day's
    /// convergence in its [`Design`](super::Design). Takes time in the cube of zones times steps.
    pub fn spectral_radius(&self, lifted: &Lifted) -> Option<f64> {
        self.settings().spectral_radius(lifted)
    }

    /// A controller of this kind before its first day. `model` is the controller's model of the building, `steps` the number
    /// of steps of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range.
    pub fn regulator(&self, model: &Model, steps: usize) -> Result<Regulator, ControlError> {
        self.settings().regulator(model, steps)
    }
}
