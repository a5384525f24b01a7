//! Climate: the building's part of the loop. Zones are entities; an iteration is a day.
//!
//! ```text
//! disturb -> control -> balance -> learn
//! ```
//!
//! The systems copy temperatures and heat between the entities and [`interplay_building::day`], which defines the order of
//! a day. When the day is over, it is measured. The heat acts on a [plant](crate::plants): the network itself, or
//! another program.

mod balance;
mod control;
mod spawn;

use bevy_ecs::prelude::*;
use interplay_building::comfort::{Agenda, Targets};
use interplay_building::control::{Control, ControlError};
use interplay_building::day::{Day, Surroundings};
use interplay_building::discretise::Model;
use thiserror::Error;

use crate::plants::{PlantError, ThermalPlant};
pub use balance::{balance, disturb};
pub use control::{control, learn};

use crate::state::detail::NotCopied;
pub use spawn::{BuildingError, ClimateState, people, surroundings_of};

/// A temperature of the building: a zone, or a wall that stores heat. Zones come first.
#[derive(Component, Clone, Copy, Debug)]
pub struct Node {
    /// Index of the node in the network.
    pub index: usize,
}

/// Temperature of a node \[°C\].
#[derive(Component, Clone, Copy, Debug)]
pub struct Temperature(pub f64);

/// The heating and cooling equipment of a zone.
#[derive(Component, Clone, Copy, Debug)]
pub struct Equipment {
    /// Heat that the controller requested \[kW\].
    pub requested_kw: f64,
    /// Heat that the equipment gives \[kW\].
    pub heat_kw: f64,
}

/// Heat from people, sun and machines in a zone \[kW\].
#[derive(Component, Clone, Copy, Debug)]
pub struct Gains(pub f64);

struct SunOfStep {
    /// Global radiation on a horizontal plane \[W/m²\].
    horizontal_w_per_m2: f64,
    /// Solar heat of each node that receives any \[kW\].
    nodes_kw: Vec<f64>,
}

/// All components of a temperature of the building.
#[derive(Clone, Debug)]
pub struct NodeState {
    /// Index of the temperature in the network.
    pub node: Node,
    /// The temperature.
    pub temperature: Temperature,
    /// Equipment and heat gains; none for a wall.
    pub zone: Option<(Equipment, Gains)>,
}

/// Why the run of a building cannot continue.
#[derive(Debug, Error)]
pub enum BuildingFailure {
    /// The controller failed.
    #[error("the controller of the building gave up: {0}")]
    Control(#[from] ControlError),
    /// The program that simulates the building did not answer as agreed.
    #[error(transparent)]
    Plant(#[from] PlantError),
}

/// The building apart from its zones: physics, surroundings and controller.
#[derive(Resource, Debug)]
pub struct Building {
    /// The model of the network in steps of time.
    pub model: Model,
    /// The controller's model of the network.
    pub believed: Model,
    /// The simulated building: the network, or another program.
    pub plant: Box<dyn ThermalPlant>,
    /// The targets of each day.
    pub agenda: Agenda,
    /// The targets of the day in progress.
    pub targets: Targets,
    /// The weather and the people.
    pub surroundings: Surroundings,
    /// The running controller.
    pub controller: Box<dyn Control>,
    /// Number of steps since the run began.
    pub step: usize,
    /// The day in progress.
    pub today: Day,
    /// Wall time of the controller today \[s\]; never part of a digest.
    pub design_s: f64,
    /// The heat of each zone in the next step, if it was decided from outside \[kW\].
    pub handed_in_kw: Option<Vec<f64>>,
    /// The failure because of which the run cannot continue, if there is one.
    pub failure: Option<BuildingFailure>,
}

impl Building {
    /// A copy that continues bit for bit as this building does.
    ///
    /// # Errors
    /// [`NotCopied`] if another program is the plant, or if the controller does not fork.
    pub fn fork(&self) -> Result<Self, NotCopied> {
        let why = || NotCopied {
            who: "the controller of the building".to_owned(),
            why: "it does not implement `fork`".to_owned(),
        };
        Ok(Building {
            model: self.model.clone(),
            believed: self.believed.clone(),
            plant: self.plant.fork()?,
            agenda: self.agenda.clone(),
            targets: self.targets.clone(),
            surroundings: self.surroundings.clone(),
            controller: self.controller.fork().ok_or_else(why)?,
            step: self.step,
            today: self.today.clone(),
            design_s: self.design_s,
            handed_in_kw: self.handed_in_kw.clone(),
            failure: None,
        })
    }

    /// Number of steps of a day.
    pub fn steps_per_day(&self) -> usize {
        self.targets.steps()
    }

    /// Electricity for heat at an outdoor temperature \[kW\].
    fn electric_kw(&self, heat_kw: f64, outdoor_c: f64) -> f64 {
        match &self.targets.supply.heat_pump {
            Some(heat_pump) => heat_kw.abs() / heat_pump.cop(heat_kw > 0.0, outdoor_c),
            None => heat_kw.abs(),
        }
    }

    /// The price of electricity in a step of today \[currency/kWh\]; none without a tariff.
    fn price_per_kwh(&self, step: usize) -> Option<f64> {
        self.targets.supply.price_per_kwh.as_ref().map(|prices| prices[step])
    }

    fn sun(&self, day: usize, step: usize) -> SunOfStep {
        let (step_s, steps) = (self.model.step_s(), self.steps_per_day());
        let start_s = (day * steps + step) as f64 * step_s;
        let horizontal = self.surroundings.weather.sun_steps_w_per_m2(start_s, step_s, 1);
        SunOfStep {
            horizontal_w_per_m2: horizontal[0],
            nodes_kw: self.surroundings.sun_kw(self.model.network(), start_s, step_s, 1),
        }
    }

    /// The day, from 0, and the step within it.
    pub fn date(&self) -> (usize, usize) {
        (self.step / self.steps_per_day(), self.step % self.steps_per_day())
    }
}
