//! What a controller is told and asked, and what it answers.

use super::design::Design;
use super::error::ControlError;
use crate::comfort::Targets;

/// What acts on a building besides its equipment, over the steps of a day.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    /// Outdoor temperature \[°C\], one per step.
    pub ambient_c: Vec<f64>,
    /// Heat from people, sun and machines \[kW\], stacked time-major: entry t·n + i is zone i in step t.
    pub gains_kw: Vec<f64>,
}

/// What a controller knows in the morning.
#[derive(Clone, Copy, Debug)]
pub struct Morning<'a> {
    /// Temperatures of the nodes at midnight \[°C\], zones first.
    pub initial_c: &'a [f64],
    /// What is wanted.
    pub targets: &'a Targets,
    /// What is expected.
    pub forecast: &'a Disturbance,
    /// What will happen: for the clairvoyant only.
    pub actual: Option<&'a Disturbance>,
}

/// What a controller sees at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// t, from zero at midnight.
    pub step: usize,
    /// Temperatures of the zones \[°C\].
    pub temperatures_c: &'a [f64],
    /// What is wanted over the day.
    pub targets: &'a Targets,
}

/// What happened. Temperatures are those at the ends of the steps; all are stacked, time-major.
#[derive(Clone, Debug, PartialEq)]
pub struct DayRecord {
    /// Temperatures of the zones T(1) … T(N) \[°C\].
    pub temperatures_c: Vec<f64>,
    /// Heat from the equipment u(0) … u(N−1), within its limits \[kW\].
    pub heat_kw: Vec<f64>,
    /// What the controller asked for \[kW\].
    pub requested_kw: Vec<f64>,
    /// How the controller came to it.
    pub design: Design,
}

impl Disturbance {
    /// Refuses one that does not fit the targets.
    pub(crate) fn check(&self, targets: &Targets) -> Result<(), ControlError> {
        ControlError::check_length("the outdoor temperature", self.ambient_c.len(), targets.steps())?;
        ControlError::check_length("the heat gains", self.gains_kw.len(), targets.reference_c.len())
    }

    /// Refuses one that has a number that is none.
    pub(super) fn check_finite(&self) -> Result<(), ControlError> {
        ControlError::check_finite("the outdoor temperature", &self.ambient_c)?;
        ControlError::check_finite("the heat gains", &self.gains_kw)
    }
}

/// A controller at work.
pub trait Control {
    /// Plans the day.
    ///
    /// # Errors
    /// [`ControlError`] if there is no plan.
    fn start_of_day(&mut self, morning: &Morning<'_>) -> Result<(), ControlError>;

    /// The heat that each zone shall get until the next step \[kW\], negative for cooling. It is asked at every step of
    /// the day, in order.
    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64>;

    /// Learns from the day.
    ///
    /// # Errors
    /// [`ControlError::Shape`] if the record is of another day or building.
    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError>;

    /// What there is to say of the day's plan.
    fn design(&self) -> Design {
        Design::default()
    }
}
