//! A copy of all state of a simulation.

use std::sync::Arc;

use bevy_ecs::prelude::World;
use interplay_scenarios::Scenario;

use super::Simulation;
use super::extensions::Extensions;
use super::saved_run::HandedInput;
use crate::measure::{BuildingMeasures, Measures};
use crate::phases::time_points::TimePoints;
use crate::simulation::run_error::RunError;
use crate::simulation::world_state::WorldState;

/// A copy of all state of a simulation between two of its steps: the planners' memory and beliefs, the bodies and their
/// contacts, the noise of sensors, the building within its day, the measures, and the inputs from outside.
///
/// A world that is resumed from it continues bit for bit like the one that was copied. It can be resumed any number of times.
pub struct Snapshot {
    pub(crate) name: String,
    pub(crate) scenario: Arc<Scenario>,
    pub(crate) time_points: TimePoints,
    pub(crate) inputs: Vec<HandedInput>,
    pub(crate) replaced: Vec<String>,
    pub(crate) extensions: Extensions,
    pub(crate) world: World,
}

impl Snapshot {
    /// A simulation that continues from here, without watchers.
    ///
    /// # Errors
    /// [`RunError::NotCopied`], only if uncopied state was added to the copy.
    pub fn resume(&self) -> Result<Simulation, RunError> {
        let mut world = WorldState::copy_from(&self.world)?.into_world(Vec::new());
        self.extensions.copy_states(&self.world, &mut world);
        let (scenario, extensions) = (Arc::clone(&self.scenario), self.extensions.clone());
        let mut simulation =
            Simulation::assembled(self.name.clone(), scenario, self.time_points.clone(), world, extensions)?;
        simulation.inputs.clone_from(&self.inputs);
        simulation.replaced.clone_from(&self.replaced);
        Ok(simulation)
    }

    pub(crate) fn digest(&self) -> String {
        let building = self.world.get_resource::<BuildingMeasures>();
        let balance = building.map(|measures| measures.digests().balance).unwrap_or_default();
        self.world.resource::<Measures>().digest.phases().physics + &balance
    }

    /// Simulated time of the snapshot \[s\].
    pub fn time_s(&self) -> f64 {
        self.time_points.reached_s()
    }
}
