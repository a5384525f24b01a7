//! Controllers, and the day that they are compared on.
//!
//! A controller is told in the morning what is wanted and expected ([`Morning`]), asked at each step for the heat of each
//! zone ([`Observation`]), and shown in the evening what happened ([`DayRecord`]). [`run_day`] does this with a model for
//! the building. A day is an iteration of the source.
//!
//! The baselines are [`thermostat`], [`pid`], plain iterative [`learning`], and the [`optimum()`] of a day that is known
//! beforehand. The designs of the source are [`iterative`] (chapter 3), [`concurrent`] (chapter 4) and [`distributed`]
//! (chapter 5, with its centralised counterpart). They plan each day with what earlier days taught, and follow the plan
//! with feedback; what they say of it is a [`Design`]. When a design fails, its controller repeats the day before, says
//! why, and goes on. A new controller is one folder and one variant of [`Controller`].
//!
//! # What the printed designs lack
//!
//! As printed, all three choose learning matrices and feedback that multiply one known vector, so that only the nominal
//! inputs matter: given a forecast they are day-ahead optimal control, learn nothing, and leave the feedback
//! undetermined. Here the expected cost under an uncertain disturbance determines the feedback, it is causal, and a bias
//! of the disturbance is learned from day to day.

mod clairvoyant;
pub mod concurrent;
mod controller;
mod day;
mod design;
pub mod distributed;
mod error;
pub mod experience;
mod follow;
pub mod iterative;
pub mod learning;
mod optimum;
pub mod pid;
pub mod stability;
pub mod thermostat;
pub mod uncertainty;

pub use clairvoyant::Clairvoyant;
pub use controller::{Controller, Regulator};
pub use day::{DayRecord, Disturbance, Morning, Observation, run_day};
pub use design::{Design, Exchange};
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

    /// What there is to say of the day's plan.
    fn design(&self) -> Design {
        Design::default()
    }
}
