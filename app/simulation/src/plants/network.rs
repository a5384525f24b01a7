//! The building's own network as the plant (eq. 2.16).

use interplay_building::discretise::Model;

use super::error::PlantError;
use super::interface::{StepInputs, ThermalPlant};
use crate::state::not_copied::NotCopied;

/// The thermal network of the scenario as the plant. It never fails.
#[derive(Clone, Debug)]
pub struct NetworkPlant {
    /// The model of the network in steps of time.
    pub model: Model,
    /// Temperature of everything at the first midnight \[°C\].
    pub initial_c: f64,
}

impl ThermalPlant for NetworkPlant {
    fn start(&mut self) -> Result<Vec<f64>, PlantError> {
        Ok(vec![self.initial_c; self.model.network().node_count()])
    }

    fn step(&mut self, inputs: &StepInputs<'_>, nodes_c: &mut [f64]) -> Result<(), PlantError> {
        self.model.step(nodes_c, inputs.heat_kw, inputs.ambient_c, inputs.gains_kw);
        Ok(())
    }

    fn is_foreign(&self) -> bool {
        false
    }

    fn fork(&self) -> Result<Box<dyn ThermalPlant>, NotCopied> {
        Ok(Box::new(self.clone()))
    }
}
