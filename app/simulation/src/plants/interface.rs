//! The interface of a plant.

use std::collections::BTreeMap;
use std::fmt::Debug;

use interplay_building::benchmark::Indicators;
use interplay_building::comfort::{Agenda, ComfortBounds};
use interplay_building::day::Surroundings;
use interplay_building::energy::Tariff;
use interplay_building::occupancy::ZoneRecord;
use interplay_building::weather::Weather;
use serde::Serialize;

use super::error::PlantError;
use crate::state::day::Metered;
use crate::state::detail::NotCopied;

/// The inputs of a building in one step, all held constant during the step. Unless stated otherwise, lists have one number per zone.
#[derive(Clone, Copy, Debug)]
pub struct StepInputs<'a> {
    /// The step, counted from the first midnight.
    pub step: usize,
    /// Heat that the equipment gives, negative when it cools \[kW\].
    pub heat_kw: &'a [f64],
    /// Heat of people, machines and sun, from the network \[kW\]: for each zone, and for the walls on which the sun shines.
    pub gains_kw: &'a [f64],
    /// Outdoor temperature \[°C\].
    pub ambient_c: f64,
}

/// A simulated building, on which the heat of the equipment acts.
pub trait ThermalPlant: Debug + Send + Sync {
    /// The temperatures of the nodes at the first midnight \[°C\], zones first. Called once, before any step.
    ///
    /// # Errors
    /// [`PlantError`] if another program does not answer as agreed.
    fn start(&mut self) -> Result<Vec<f64>, PlantError>;

    /// Moves the temperatures of the nodes \[°C\] by one step.
    ///
    /// # Errors
    /// As [`ThermalPlant::start`]; the temperatures are then unchanged.
    fn step(&mut self, inputs: &StepInputs<'_>, nodes_c: &mut [f64]) -> Result<(), PlantError>;

    /// Whether another program is the plant: the network is then a model of it, and temperatures of walls are estimated.
    fn is_foreign(&self) -> bool;

    /// What the plant knows in advance about the whole run, after its start; it replaces the statements of the scenario.
    fn foreseen(&self) -> Option<&Foreseen> {
        None
    }

    /// The reading of the electricity meter on the last completed day.
    fn metered(&self) -> Option<Metered> {
        None
    }

    /// The indicators of a benchmark, once its last step is over.
    fn benchmark(&self) -> Option<&Benchmark> {
        None
    }

    /// A copy in the same state.
    ///
    /// # Errors
    /// [`NotCopied`] if its state is elsewhere.
    fn fork(&self) -> Result<Box<dyn ThermalPlant>, NotCopied>;
}

/// The indicators of a completed test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Benchmark {
    /// The indicators that BOPTEST computed, by its names; an indicator that the case does not have is `null`.
    pub official: BTreeMap<String, Option<f64>>,
    /// The indicators that we computed from the same measurements; none without `building.plant.indicators`.
    pub ours: Option<Indicators>,
    /// Mean share of a step between an answer and the next request, by the clock.
    pub time_ratio: Option<f64>,
}

impl Benchmark {
    /// Combines BOPTEST's indicators, by name, with ours. `control_s` is the duration of each decision.
    pub fn new(
        official: BTreeMap<String, Option<f64>>,
        ours: Option<Indicators>,
        control_s: &[f64],
        step_s: f64,
    ) -> Self {
        let time_ratio = Indicators::computational_time_ratio(control_s, step_s);
        Self { official, ours, time_ratio }
    }
}

/// Weather, people, comfort bounds and prices of a whole run, which replace those of the scenario.
#[derive(Clone, Debug)]
pub struct Foreseen {
    /// The weather from the first midnight on.
    pub weather: Weather,
    /// Heat of people and machines, for the zones with known values.
    pub people: Vec<ZoneRecord>,
    /// Comfort bounds; none keeps the scenario's targets.
    pub bounds: Option<ComfortBounds>,
    /// Prices of electricity; none keeps the scenario's.
    pub tariff: Option<Tariff>,
}

impl Foreseen {
    /// Replaces the weather and people of the scenario.
    #[must_use]
    pub fn around(&self, surroundings: Surroundings) -> Surroundings {
        let mut surroundings = Surroundings { weather: self.weather.clone(), ..surroundings };
        let known = |zone: usize| self.people.iter().any(|record| record.zone == zone);
        surroundings.recorded.zones.retain(|record| !known(record.zone));
        surroundings.recorded.zones.extend(self.people.iter().cloned());
        surroundings
    }

    /// Replaces the targets and prices of the scenario.
    #[must_use]
    pub fn wanted(&self, agenda: Agenda) -> Agenda {
        let agenda = match &self.bounds {
            Some(bounds) => agenda.bounded(bounds.clone()),
            None => agenda,
        };
        match &self.tariff {
            Some(tariff) => agenda.priced(tariff.clone()),
            None => agenda,
        }
    }
}
