//! The interface of a plant.

use std::fmt::Debug;

use super::benchmark::Benchmark;
use super::error::PlantError;
use super::foreseen::Foreseen;
use crate::state::day::Metered;
use crate::state::not_copied::NotCopied;

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
