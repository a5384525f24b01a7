//! The interface of controllers: settings ([`ControllerKind`]), the running controller ([`Control`]), and its inputs and outputs.

use std::fmt;

use super::design::Design;
use super::error::ControlError;
use crate::comfort::Targets;
use crate::discretise::Model;
use crate::lifted::Lifted;
use crate::network::Network;

/// The disturbance of a building over the steps of a day: all that acts on it besides its equipment.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    /// Outdoor temperature \[°C\], one per step.
    pub ambient_c: Vec<f64>,
    /// Heat from people, sun and machines \[kW\], stacked time-major: entry t·m + i is node i in step t, of the m nodes that get
    /// any ([`Network::gain_count`]): the zones, and the walls where the sun falls on one.
    pub gains_kw: Vec<f64>,
}

/// What a controller knows at midnight, when it plans the day.
#[derive(Clone, Copy, Debug)]
pub struct DayAhead<'a> {
    /// Temperatures of the nodes at midnight \[°C\], zones first.
    pub initial_c: &'a [f64],
    /// The targets of the day.
    pub targets: &'a Targets,
    /// The forecast disturbance.
    pub forecast: &'a Disturbance,
    /// What is forecast for the day after, where that is known.
    pub outlook: Option<&'a Disturbance>,
    /// The actual disturbance, for the clairvoyant controller only.
    pub actual: Option<&'a Disturbance>,
}

/// What a controller measures at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// The step t, counted from midnight.
    pub step: usize,
    /// Temperatures of the zones \[°C\].
    pub temperatures_c: &'a [f64],
    /// The targets of the day.
    pub targets: &'a Targets,
}

/// The record of a day. Temperatures are those at the ends of the steps; all series are stacked, time-major.
#[derive(Clone, Debug, PartialEq)]
pub struct DayRecord {
    /// Temperatures of the zones T(1) … T(N) \[°C\].
    pub temperatures_c: Vec<f64>,
    /// Heat from the equipment u(0) … u(N−1), within its limits \[kW\].
    pub heat_kw: Vec<f64>,
    /// The heat that the controller requested \[kW\].
    pub requested_kw: Vec<f64>,
    /// How the controller planned the day.
    pub design: Design,
}

impl Observation<'_> {
    /// r(t) − T(t) \[K\] of each zone, zero where its temperature is free, and at midnight: the feedback of a design that has no
    /// plan yet acts on it.
    pub(super) fn weighted_errors_k(&self) -> Vec<f64> {
        if self.step == 0 {
            return vec![0.0; self.temperatures_c.len()];
        }
        let wanted = self.targets.reference_at(self.step).iter().zip(self.targets.weight_at(self.step));
        let error_k = |((wanted_c, weight), actual_c): ((&f64, &f64), &f64)| {
            if *weight > 0.0 { wanted_c - actual_c } else { 0.0 }
        };
        wanted.zip(self.temperatures_c).map(error_k).collect()
    }
}

impl Disturbance {
    /// Refuses a disturbance whose lengths do not fit the targets and the network.
    pub(crate) fn check(&self, targets: &Targets, network: &Network) -> Result<(), ControlError> {
        ControlError::check_length("the outdoor temperature", self.ambient_c.len(), targets.steps())?;
        ControlError::check_length("the heat gains", self.gains_kw.len(), targets.steps() * network.gain_count())
    }

    /// Refuses a disturbance with a number that is not finite.
    pub(super) fn check_finite(&self) -> Result<(), ControlError> {
        ControlError::check_finite("the outdoor temperature", &self.ambient_c)?;
        ControlError::check_finite("the heat gains", &self.gains_kw)
    }
}

/// The settings of one kind of controller, and everything about such a controller that is known before its first day.
pub trait ControllerKind: fmt::Debug + Send + Sync {
    /// The word for this kind in a scenario file.
    fn kind(&self) -> &'static str;

    /// What tells the results of this kind from those of its earlier versions, such as `env!("CARGO_PKG_VERSION")`; empty for those
    /// of Interplay, whose version counts for all of them.
    fn version(&self) -> &'static str {
        ""
    }

    /// A controller of this kind before its first day. `model` is the controller's model of the building, `steps` the number
    /// of steps of a day.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if a setting is out of range.
    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError>;

    /// Whether this kind plans each day, and describes the plan in a [`Design`].
    fn plans(&self) -> bool {
        false
    }

    /// The key of a setting, and the reason, because of which all days must have the same targets and people; `None` if
    /// weekdays may differ.
    fn needs_equal_days(&self) -> Option<(&'static str, &'static str)> {
        None
    }

    /// About how many operations it takes to design a day of `zones` zones and `steps` steps.
    ///
    /// Leading terms, with factors that fit the times of `docs/evidence/building-benchmarks.md` at about 5e8 operations a second. They tell
    /// a second from an hour, and not one second from two.
    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        zones * steps
    }

    /// What to look for in a run, as the end of a sentence that begins with "Look for:".
    fn look_for(&self) -> &'static str;

    /// The spectral radius of the map from the errors of one day to those of the next, for equal days and no feedback.
    /// Below 1 the errors vanish in the end. `lifted` is the model of a day.
    ///
    /// Returns `None` if the settings do not determine it: the kind does not learn, or it describes each day's
    /// convergence in its [`Design`]. Takes time in the cube of zones times steps.
    fn spectral_radius(&self, _lifted: &Lifted) -> Option<f64> {
        None
    }
}

/// A running controller with its state.
pub trait Control: fmt::Debug + Send + Sync {
    /// Plans the day.
    ///
    /// # Errors
    /// [`ControlError`] if the controller cannot work on this day.
    fn start_of_day(&mut self, _day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        Ok(())
    }

    /// Returns the heat that each zone shall get until the next step \[kW\], negative for cooling. Called once for each step
    /// of the day, in order.
    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64>;

    /// Learns from the day.
    ///
    /// # Errors
    /// [`ControlError::Shape`] if the record is of another day or building.
    fn end_of_day(&mut self, _record: &DayRecord) -> Result<(), ControlError> {
        Ok(())
    }

    /// Why the last step follows an earlier plan than its own; `None` if it has its own.
    fn trouble(&self) -> Option<&ControlError> {
        None
    }

    /// Describes the plan of the day.
    fn design(&self) -> Design {
        Design::default()
    }

    /// A copy with the same state, for snapshots of a run. `None` for a controller that cannot be copied.
    fn fork(&self) -> Option<Box<dyn Control>> {
        None
    }
}
