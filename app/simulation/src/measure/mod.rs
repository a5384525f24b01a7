//! Measure: one metric a file, all fed with the same frames.

mod building;
mod comfort;
mod completion;
mod digest;
mod gap;
mod milestones;
mod planning;
mod speed;

use bevy_ecs::prelude::*;
use interplay_planners::State;
use interplay_scenarios::Scenario;

pub use building::{BuildingDigests, BuildingMeasures, Fallback, measure_building};
pub use comfort::RideComfort;
pub use completion::Completion;
pub use digest::{Digest, PhaseDigests};
pub use gap::SmallestGap;
pub use milestones::Milestones;
pub use planning::Planning;
pub use speed::SpeedRange;

use crate::components::{Clock, CurrentFrame, Identity, Motion};
use crate::frame::Collision;

/// Everything that is measured in a run.
#[derive(Resource, Clone, Debug)]
pub struct Measures {
    /// Contacts, in order.
    pub collisions: Vec<Collision>,
    /// Distance of the ego's footprint to the others'.
    pub gap: SmallestGap,
    /// Digest of the run, by phase.
    pub digest: Digest,
    /// What happens that is worth a line in the log.
    pub milestones: Milestones,
    /// Per vehicle, in the scenario's order.
    pub vehicles: Vec<VehicleMeasures>,
}

/// What is measured of one vehicle.
#[derive(Clone, Debug)]
pub struct VehicleMeasures {
    /// When it reached its goal.
    pub completion: Completion,
    /// How smoothly it drove.
    pub comfort: RideComfort,
    /// How fast it drove.
    pub speed: SpeedRange,
    /// How its planner did.
    pub planning: Planning,
    /// Its last state.
    pub last: State,
}

impl Measures {
    /// Nothing measured yet.
    pub fn new(scenario: &Scenario) -> Self {
        let vehicles = scenario.vehicles.iter().zip(scenario.starts()).map(|(vehicle, start)| VehicleMeasures {
            completion: Completion::new(vehicle, &scenario.road),
            comfort: RideComfort::new(scenario.step_s),
            speed: SpeedRange::new(start.speed_mps),
            planning: Planning::default(),
            last: start,
        });
        Measures {
            collisions: Vec::new(),
            gap: SmallestGap::default(),
            digest: Digest::default(),
            milestones: Milestones::new(scenario),
            vehicles: vehicles.collect(),
        }
    }
}

/// Feeds the tick's frame and the states that it led to into every metric.
pub fn measure(
    vehicles: Query<(&Identity, &Motion)>,
    clock: Res<Clock>,
    mut current_frame: ResMut<CurrentFrame>,
    mut measures: ResMut<Measures>,
) {
    let frame = &mut current_frame.0;
    let measures = &mut *measures;
    let mut after: Vec<State> = frame.vehicles.iter().map(|vehicle| vehicle.state).collect();
    for (identity, motion) in &vehicles {
        after[identity.index] = motion.state;
    }
    for ((vehicle, measured), state) in frame.vehicles.iter().zip(&mut measures.vehicles).zip(&after) {
        measured.planning.observe(vehicle);
        measured.comfort.observe(&vehicle.input);
        if measured.completion.observe(state, clock.time_s()) {
            frame.events.push(milestones::arrival(&vehicle.name, measured.completion.crosses()));
        }
        measured.speed.observe(state.speed_mps);
        measured.last = *state;
    }
    let begun = measures.milestones.observe(frame);
    frame.events.extend(begun);
    measures.gap.observe(frame);
    measures.collisions.extend_from_slice(&frame.collisions);
    measures.digest.observe(frame, &after);
}
