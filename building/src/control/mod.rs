//! Controllers.
//!
//! At midnight a controller gets the targets and the forecast of the day ([`DayAhead`]). At each step it gets the
//! temperatures ([`Observation`]) and returns the heat of each zone. At the end of the day it gets the record of the
//! day ([`DayRecord`]). [`crate::day`] runs days with it. A day is an iteration of the dissertation.
//!
//! The baselines are [`thermostat`], [`pid`], plain iterative [`learning`], model [`predictive`] control, and the [`optimum()`] of a day
//! that is known beforehand. [`economic`] model predictive control minimises money. The designs of the dissertation are [`iterative`]
//! (chapter 3), [`concurrent`] (chapter 4) and [`distributed`] (chapter 5, with its centralised counterpart). They plan each day from the
//! experience of earlier days and follow the plan with feedback; a [`Design`] describes the plan. If a design fails, its controller
//! repeats the previous day and gives the reason. The settings of each kind implement [`ControllerKind`], and the running controller
//! implements [`Control`]; [`Controller`] lists all kinds.
//!
//! # What the printed designs lack
//!
//! As printed, all three choose learning matrices and feedback that multiply one known vector, so only the nominal inputs matter: given a
//! forecast, they are day-ahead optimal control, learn nothing, and leave the feedback undetermined. Here the expected cost under an
//! uncertain disturbance determines the feedback, the feedback is causal, and a bias of the disturbance is learned from day to day.

mod clairvoyant;
pub mod concurrent;
mod controller;
pub mod cooperative;
mod design;
pub mod distributed;
pub mod disturbance_estimate;
pub mod economic;
mod error;
mod interface;
pub mod iterative;
pub mod learning;
pub(crate) mod money_stages;
mod optimum;
pub mod pid;
mod planning;
mod powers;
pub mod predictive;
pub mod stability;
pub mod thermostat;
pub mod uncertainty;

pub use clairvoyant::{Clairvoyant, ClairvoyantSettings};
pub use controller::{Controller, ForeignController};
pub use design::{Design, Exchange};
pub use error::ControlError;
pub use interface::{Control, ControllerKind, DayAhead, DayRecord, Disturbance, Observation};
pub use optimum::{BandPenalty, DayOptimum, optimum};
