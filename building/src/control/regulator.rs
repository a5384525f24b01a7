//! A controller of any kind with its state, and what every kind provides.

use std::fmt;

use super::design::Design;
use super::error::ControlError;
use super::interface::{Control, DayAhead, DayRecord, Observation};
use crate::discretise::Model;
use crate::lifted::Lifted;

/// The settings of one kind of controller.
pub trait ControllerKind {
    /// The word for this kind in a scenario file.
    fn kind(&self) -> &'static str;

    /// Whether this kind plans each day, and describes the plan in a [`Design`].
    fn plans(&self) -> bool {
        false
    }

    /// The key of a setting, and the reason, because of which all days must have the same targets and people; `None` if
    /// weekdays may differ.
    fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        None
    }

    /// What to look for in a run, as the end of a sentence that begins with "Look for:".
    fn look_for(&self) -> &'static str;

    /// The spectral radius of the map from the errors of one day to those of the next, for equal days and no feedback.
    /// `None` if the settings do not determine it. `lifted` is the model of a day.
    fn spectral_radius(&self, _lifted: &Lifted) -> Option<f64> {
        None
    }

    /// A controller of this kind before its first day. `model` is the controller's model of the building, `steps` the number
    /// of steps of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range.
    fn regulator(&self, model: &Model, steps: usize) -> Result<Regulator, ControlError>;
}

/// A controller of any kind with its state.
#[derive(Debug)]
pub struct Regulator(Box<dyn AnyControl>);

/// A controller that can be cloned behind a pointer.
trait AnyControl: Control + fmt::Debug + Send + Sync {
    fn boxed_clone(&self) -> Box<dyn AnyControl>;
}

impl<C: Control + Clone + fmt::Debug + Send + Sync + 'static> AnyControl for C {
    fn boxed_clone(&self) -> Box<dyn AnyControl> {
        Box::new(self.clone())
    }
}

impl Regulator {
    /// Wraps a controller.
    pub fn new(controller: impl Control + Clone + fmt::Debug + Send + Sync + 'static) -> Self {
        Self(Box::new(controller))
    }
}

impl Clone for Regulator {
    fn clone(&self) -> Self {
        Self(self.0.boxed_clone())
    }
}

impl Control for Regulator {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        self.0.start_of_day(day_ahead)
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        self.0.act(observation)
    }

    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError> {
        self.0.end_of_day(record)
    }

    fn trouble(&self) -> Option<&ControlError> {
        self.0.trouble()
    }

    fn design(&self) -> Design {
        self.0.design()
    }
}
