//! A snapshot as text: the scenario, the inputs from outside, and the progress of the run.
//!
//! A run is a function of its scenario and of its inputs, bit for bit. Only these are saved: the reader repeats the run
//! up to the same step, and a digest of all states proves that it is the same. The text stays small, whatever planners and bodies
//! remember, and is readable. Reading it takes as long as the run took.

use std::sync::Arc;

use bevy_ecs::prelude::World;
use interplay_planners::Input;
use interplay_scenarios::{LoadError, Registry, Scenario};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::Simulation;
use super::extensions::Extensions;
use crate::measure::{BuildingMeasures, Measures};
use crate::phases::time_points::TimePoints;
use crate::simulation::run_error::RunError;
use crate::simulation::world_state::WorldState;
use crate::state::components::HandedIn;
use crate::state::detail::NotCopied;

const FORMAT: u32 = 1;

/// Inputs of a vehicle from outside, before a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HandedInput {
    /// Number of steps completed before.
    pub step: usize,
    pub vehicle: String,
    /// One input, or those of a plan.
    pub inputs: Vec<Input>,
    /// Whether they are a plan, which the others know.
    pub is_plan: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedRun {
    format: u32,
    program: String,
    name: String,
    scenario: String,
    steps: usize,
    inputs: Vec<HandedInput>,
    digest: String,
}

/// Why a snapshot cannot be written or read as text.
#[derive(Debug, Error)]
pub enum SavedRunError {
    /// A driver that is not part of the scenario has taken over.
    #[error(transparent)]
    NotCopied(#[from] NotCopied),
    /// The text is not a snapshot.
    #[error("this is not a snapshot: {0}")]
    Text(#[from] serde_json::Error),
    /// The text has another version of the format.
    #[error(
        "this snapshot has form {found}, and this program reads form {FORMAT}; it was written by Interplay {program}"
    )]
    Format {
        /// Its version.
        found: u32,
        /// The version of the program that wrote it.
        program: String,
    },
    /// The scenario of the text is refused.
    #[error("the scenario of the snapshot is refused: {0}")]
    Scenario(#[from] LoadError),
    /// The run of the text fails when it is repeated.
    #[error("the run of the snapshot cannot be repeated: {0}")]
    Run(#[from] RunError),
    /// The repeated run differs.
    #[error(
        "the run of the snapshot goes otherwise in this program: it was written by Interplay {program}, and drivers behave \
         differently since"
    )]
    OtherRun {
        /// The version of the program that wrote it.
        program: String,
    },
}

impl HandedInput {
    /// The record of an input from outside, if there was one.
    pub(crate) fn of(step: usize, vehicle: &str, handed_in: &HandedIn) -> Option<Self> {
        let (inputs, is_plan) = match handed_in {
            HandedIn::NotExternal | HandedIn::Awaited => return None,
            HandedIn::Input(input) => (vec![*input], false),
            HandedIn::Plan(inputs) => (inputs.clone(), true),
        };
        Some(HandedInput { step, vehicle: vehicle.to_owned(), inputs, is_plan })
    }
}

impl Snapshot {
    /// The snapshot as JSON, for a file; [`Snapshot::from_json`] reads it.
    ///
    /// # Errors
    /// [`SavedRunError::NotCopied`] if a driver that the scenario does not name has taken over by [`Simulation::drive_with`], or
    /// if systems were added.
    pub fn to_json(&self) -> Result<String, SavedRunError> {
        if let Some(vehicle) = self.course.replaced.first() {
            let why = "it is not part of the scenario; give the vehicle a `driver` of a registered kind".to_owned();
            return Err(NotCopied { who: format!("the driver that has taken over `{vehicle}`"), why }.into());
        }
        if let Some(system) = self.course.extensions.first_system() {
            let why = "it is not part of the scenario".to_owned();
            return Err(NotCopied { who: format!("the added system `{system}`"), why }.into());
        }
        let saved = SavedRun {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            name: self.course.name.clone(),
            scenario: self.course.scenario.to_file().to_toml(),
            steps: self.course.time_points.passed(),
            inputs: self.course.inputs.clone(),
            digest: self.digest(),
        };
        Ok(serde_json::to_string_pretty(&saved)?)
    }

    /// Reads the text of [`Snapshot::to_json`] and repeats the run up to the snapshot, which takes as long as the run
    /// took. `registry` has the kinds of drivers that the scenario may name.
    ///
    /// # Errors
    /// [`SavedRunError`], if the text is not a snapshot or the repeated run reaches other states.
    pub fn from_json(text: &str, registry: &Registry) -> Result<Snapshot, SavedRunError> {
        let saved: SavedRun = serde_json::from_str(text)?;
        let program = saved.program;
        if saved.format != FORMAT {
            return Err(SavedRunError::Format { found: saved.format, program });
        }
        let scenario = registry.from_text("snapshot.toml", &saved.scenario, &[])?;
        let mut simulation = Simulation::watched(&saved.name, &scenario, Vec::new())?;
        let mut inputs = saved.inputs.into_iter().peekable();
        for step in 0..saved.steps {
            while let Some(handed) = inputs.next_if(|handed| handed.step == step) {
                match (handed.is_plan, handed.inputs.as_slice()) {
                    (false, [input]) => simulation.apply(&handed.vehicle, *input)?,
                    (_, inputs) => simulation.apply_plan(&handed.vehicle, inputs)?,
                }
            }
            simulation.step()?;
        }
        let snapshot = simulation.snapshot()?;
        if snapshot.digest() == saved.digest { Ok(snapshot) } else { Err(SavedRunError::OtherRun { program }) }
    }
}

impl Simulation {
    /// A copy that continues on its own, without watchers: [`Simulation::snapshot`] and [`Snapshot::resume`] in one, with one copy of the
    /// state instead of two.
    ///
    /// # Errors
    /// As [`Simulation::snapshot`].
    pub fn fork(&self) -> Result<Simulation, RunError> {
        let Snapshot { course, world } = self.snapshot()?;
        Simulation::assembled(course, world)
    }
}

/// A copy of all state of a simulation between two of its steps: the planners' memory and beliefs, the bodies and their
/// contacts, the noise of sensors, the building within its day, the measures, and the inputs from outside.
///
/// A world that is resumed from it continues bit for bit like the one that was copied. It can be resumed any number of times.
pub struct Snapshot {
    pub(crate) course: Course,
    pub(crate) world: World,
}

/// What a simulation is besides its world: what is run, how far it has come, and what came from outside.
#[derive(Clone)]
pub(crate) struct Course {
    pub name: String,
    pub scenario: Arc<Scenario>,
    pub time_points: TimePoints,
    /// The caller's inputs, in order.
    pub inputs: Vec<HandedInput>,
    /// Vehicles whose driver was replaced by one that the scenario does not name.
    pub replaced: Vec<String>,
    pub extensions: Extensions,
}

impl Snapshot {
    /// A simulation that continues from here, without watchers.
    ///
    /// # Errors
    /// [`RunError::NotCopied`], only if uncopied state was added to the copy.
    pub fn resume(&self) -> Result<Simulation, RunError> {
        let mut world = WorldState::copy_from(&self.world)?.into_world(Vec::new());
        self.course.extensions.copy_states(&self.world, &mut world);
        Simulation::assembled(self.course.clone(), world)
    }

    pub(crate) fn digest(&self) -> String {
        let building = self.world.get_resource::<BuildingMeasures>();
        let balance = building.map(|measures| measures.digests().balance).unwrap_or_default();
        self.world.resource::<Measures>().digest.phases().physics + &balance
    }

    /// Simulated time of the snapshot \[s\].
    pub fn time_s(&self) -> f64 {
        self.course.time_points.reached_s()
    }
}
