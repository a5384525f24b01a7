//! The list of all controllers, with the word that a scenario file uses for each.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clairvoyant::{self, Clairvoyant};
use super::concurrent::{self, Concurrent, ConcurrentSettings};
use super::distributed::{self, Centralised, CentralisedSettings, Distributed, DistributedSettings};
use super::iterative::{self, Iterative, IterativeSettings};
use super::learning::{self, Learning, LearningSettings};
use super::pid::{self, Pid, PidSettings};
use super::thermostat::{self, Thermostat, ThermostatSettings};
use super::{Control, ControlError, DayAhead, DayRecord, Design, Observation};
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

/// A controller with its settings and its state.
#[derive(Clone, Debug)]
pub enum Regulator {
    /// See [`Thermostat`].
    Thermostat(Thermostat),
    /// See [`Pid`].
    Pid(Pid),
    /// See [`Learning`].
    IterativeLearning(Box<Learning>),
    /// See [`Clairvoyant`].
    Clairvoyant(Box<Clairvoyant>),
    /// See [`Iterative`].
    Iterative(Box<Iterative>),
    /// See [`Concurrent`].
    Concurrent(Box<Concurrent>),
    /// See [`Distributed`].
    Distributed(Box<Distributed>),
    /// See [`Centralised`].
    Centralised(Box<Centralised>),
}

impl Controller {
    /// A controller of this kind before its first day. `model` is the controller's model of the building, `steps` the number
    /// of steps of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range.
    pub fn regulator(&self, model: &Model, steps: usize) -> Result<Regulator, ControlError> {
        let limits_kw = model.network().limits_kw();
        Ok(match *self {
            Self::Thermostat(settings) => Regulator::Thermostat(Thermostat::new(settings, limits_kw)?),
            Self::Pid(settings) => Regulator::Pid(Pid::new(settings, limits_kw, model.step_s())?),
            Self::IterativeLearning(settings) => {
                Regulator::IterativeLearning(Box::new(Learning::new(settings, Lifted::new(model, steps))?))
            }
            Self::Clairvoyant => Regulator::Clairvoyant(Box::new(Clairvoyant::new(Lifted::new(model, steps)))),
            Self::Iterative(settings) => {
                Regulator::Iterative(Box::new(Iterative::new(settings, Lifted::new(model, steps))?))
            }
            Self::Concurrent(settings) => {
                Regulator::Concurrent(Box::new(Concurrent::new(settings, Lifted::new(model, steps))?))
            }
            Self::Distributed(settings) => Regulator::Distributed(Box::new(Distributed::new(settings, model, steps)?)),
            Self::Centralised(settings) => {
                Regulator::Centralised(Box::new(Centralised::new(settings, Lifted::new(model, steps))?))
            }
        })
    }

    /// Whether this kind of controller plans each day, and describes the plan in a [`Design`].
    pub fn plans(&self) -> bool {
        match self {
            Self::Thermostat(_) | Self::Pid(_) | Self::IterativeLearning(_) | Self::Clairvoyant => false,
            Self::Iterative(_) | Self::Concurrent(_) | Self::Distributed(_) | Self::Centralised(_) => true,
        }
    }

    /// What to look for in a recording of a building with this kind of controller: a clause without a full stop.
    pub fn look_for(&self) -> &'static str {
        match self {
            Self::Thermostat(_) => thermostat::LOOK_FOR,
            Self::Pid(_) => pid::LOOK_FOR,
            Self::IterativeLearning(_) => learning::LOOK_FOR,
            Self::Clairvoyant => clairvoyant::LOOK_FOR,
            Self::Iterative(_) => iterative::LOOK_FOR,
            Self::Concurrent(_) => concurrent::LOOK_FOR,
            Self::Distributed(_) => distributed::LOOK_FOR,
            Self::Centralised(_) => distributed::LOOK_FOR_CENTRALISED,
        }
    }

    /// The word for this kind of controller in a scenario file.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Thermostat(_) => "thermostat",
            Self::Pid(_) => "pid",
            Self::IterativeLearning(_) => "iterative-learning",
            Self::Clairvoyant => "clairvoyant",
            Self::Iterative(_) => "iterative",
            Self::Concurrent(_) => "concurrent",
            Self::Distributed(_) => "distributed",
            Self::Centralised(_) => "centralised",
        }
    }
}

impl Regulator {
    fn control(&mut self) -> &mut dyn Control {
        match self {
            Self::Iterative(iterative) => iterative.as_mut(),
            Self::Concurrent(concurrent) => concurrent.as_mut(),
            Self::Distributed(distributed) => distributed.as_mut(),
            Self::Centralised(centralised) => centralised.as_mut(),
            Self::Thermostat(thermostat) => thermostat,
            Self::Pid(pid) => pid,
            Self::IterativeLearning(learning) => learning.as_mut(),
            Self::Clairvoyant(clairvoyant) => clairvoyant.as_mut(),
        }
    }
}

impl Control for Regulator {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        self.control().start_of_day(day_ahead)
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        self.control().act(observation)
    }

    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError> {
        self.control().end_of_day(record)
    }

    fn design(&self) -> Design {
        match self {
            Self::Thermostat(_) | Self::Pid(_) | Self::IterativeLearning(_) | Self::Clairvoyant(_) => Design::default(),
            Self::Iterative(iterative) => iterative.design(),
            Self::Concurrent(concurrent) => concurrent.design(),
            Self::Distributed(distributed) => distributed.design(),
            Self::Centralised(centralised) => centralised.design(),
        }
    }
}
