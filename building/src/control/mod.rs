//! Controllers, and the day that they are compared on.
//!
//! A controller is told in the morning what is wanted and expected ([`Morning`]), asked at each step for the heat of each
//! zone ([`Observation`]), and shown in the evening what happened ([`DayRecord`]). [`run_day`] does this with a model for
//! the building. A day is an iteration of the source.
//!
//! The baselines are here: [`thermostat`], [`pid`], plain iterative [`learning`], and the [`optimum()`] of a day that is
//! known beforehand. A new controller is one file and one variant of [`Controller`].

mod clairvoyant;
mod controller;
mod day;
mod error;
pub mod learning;
mod optimum;
pub mod pid;
pub mod thermostat;

pub use clairvoyant::Clairvoyant;
pub use controller::{Controller, Regulator};
pub use day::{DayRecord, Disturbance, Morning, Observation, run_day};
pub use error::ControlError;
pub use optimum::{BandPenalty, Optimum, optimum};

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
}
