//! A copy of all state of a simulation.

use std::sync::Arc;

use bevy_ecs::prelude::World;
use interplay_scenarios::Scenario;

use crate::run::RunError;
use crate::simulation::Simulation;
use crate::time_points::TimePoints;
use crate::world_state::WorldState;

/// A copy of all state of a simulation between two of its steps: what the planners remember and believe, the bodies and who touches
/// whom, the noise of sensors, the building in the middle of its day, what was measured, and what was handed in from outside.
///
/// A world that is resumed from it goes on bit for bit as the one that was copied. It can be resumed any number of times.
pub struct Snapshot {
    pub(crate) name: String,
    pub(crate) scenario: Arc<Scenario>,
    pub(crate) time_points: TimePoints,
    pub(crate) world: World,
}

impl Snapshot {
    /// The simulation goes on from here, watched by nobody.
    ///
    /// # Errors
    /// [`RunError::NotCopied`]; never, if nothing was added to the copy.
    pub fn resume(&self) -> Result<Simulation, RunError> {
        let parts = (Arc::clone(&self.scenario), self.time_points.clone());
        Simulation::assembled(&self.name, parts, WorldState::of(&self.world)?, Vec::new())
    }

    /// Simulated time at which it was taken \[s\].
    pub fn time_s(&self) -> f64 {
        self.time_points.reached_s()
    }
}
