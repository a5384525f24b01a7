//! Climate: the building's part of the loop. Zones are entities; an iteration is a day.
//!
//! ```text
//! disturb -> control -> balance -> learn
//! ```
//!
//! At midnight the day's weather and people are drawn and forecast, and the controller plans. At every step it is asked
//! for the heat of each zone, and the heat balance moves the temperatures on (eq. 2.15). At the day's end the controller
//! learns, and the day is handed on to be measured.

mod balance;
mod control;
mod disturbance;
mod learn;
mod spawn;

use bevy::ecs::prelude::*;
use interplay_building::comfort::Targets;
use interplay_building::control::{ControlError, DayRecord, Disturbance, Regulator};
use interplay_building::discretise::Model;
use interplay_building::occupancy::People;
use interplay_building::weather::{Forecast, Weather};

pub use balance::balance;
pub use control::control;
pub use disturbance::disturb;
pub use learn::learn;
pub use spawn::{BuildingError, people, spawn};

/// A temperature of the building: a zone, or a wall that stores heat. Zones come first.
#[derive(Component, Clone, Copy, Debug)]
pub struct Node {
    /// Its number in the network.
    pub index: usize,
}

/// How warm a node is \[°C\].
#[derive(Component, Clone, Copy, Debug)]
pub struct Temperature(pub f64);

/// What heats and cools a zone.
#[derive(Component, Clone, Copy, Debug)]
pub struct Equipment {
    /// Its largest power \[kW\].
    pub limit_kw: f64,
    /// What the controller asked for \[kW\].
    pub requested_kw: f64,
    /// What it gives \[kW\].
    pub heat_kw: f64,
}

/// Heat from people, sun and machines in a zone \[kW\].
#[derive(Component, Clone, Copy, Debug)]
pub struct Gains(pub f64);

/// The building beside its zones: its physics, its surroundings, its controller.
#[derive(Resource, Debug)]
pub struct Building {
    /// The network with its step.
    pub model: Model,
    /// What is wanted.
    pub targets: Targets,
    /// The weather since the first midnight.
    pub weather: Weather,
    /// How it is forecast, and from which seed.
    pub forecast: (Forecast, u64),
    /// The people.
    pub people: People,
    /// The controller at work.
    pub regulator: Regulator,
    /// Steps done.
    pub step: usize,
    /// The day in the making.
    pub today: Today,
    /// Why the controller gave up, if it did.
    pub failure: Option<ControlError>,
}

/// A day in the making.
#[derive(Clone, Debug)]
pub struct Today {
    /// Temperatures of the nodes at midnight \[°C\].
    pub initial_c: Vec<f64>,
    /// What was expected.
    pub forecast: Disturbance,
    /// What happens.
    pub actual: Disturbance,
    /// What happened so far.
    pub record: DayRecord,
    /// Wall time of planning and learning \[s\]; never part of a digest.
    pub design_s: f64,
}

impl Building {
    /// Steps of a day.
    pub fn steps_per_day(&self) -> usize {
        self.targets.steps()
    }

    /// The day, from 0, and the step within it.
    pub fn date(&self) -> (usize, usize) {
        (self.step / self.steps_per_day(), self.step % self.steps_per_day())
    }
}
