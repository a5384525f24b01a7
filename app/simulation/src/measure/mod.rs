//! Measure: one metric a file, all fed with the same frames.

mod beliefs;
mod building;
mod comfort;
mod completion;
mod digest;
mod gap;
mod milestones;
mod off_road;
mod peak;
mod planning;
mod right_of_way;
mod speed;
mod speeding;
mod time_to_collision;

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::{Route, State};
use interplay_scenarios::{Scenario, Vehicle};

pub use beliefs::{Beliefs, HeldBelief};
pub use building::{BuildingDigests, BuildingMeasures, Fallback, measure_building};
pub use comfort::RideComfort;
pub use completion::Completion;
pub use digest::{Digest, PhaseDigests};
pub use gap::SmallestGap;
pub use milestones::Milestones;
pub use off_road::OffRoad;
pub use peak::Peak;
pub use planning::Planning;
pub use right_of_way::{Passage, Passages};
pub use speed::SpeedRange;
pub use speeding::Speeding;
pub use time_to_collision::{ShortestTimeToCollision, TimeToCollision};

use crate::components::{Clock, CurrentFrame, Identity, Motion};
use crate::frame::Collision;

/// Everything that is measured in a run.
#[derive(Resource, Clone, Debug)]
pub struct Measures {
    /// Contacts, in order.
    pub collisions: Vec<Collision>,
    /// Distances between footprints.
    pub gap: SmallestGap,
    /// How soon two vehicles would have touched.
    pub time_to_collision: ShortestTimeToCollision,
    /// Who went first where ways cross or merge.
    pub passages: Passages,
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
    /// How far it left its road.
    pub off_road: OffRoad,
    /// How far it exceeded speed limits.
    pub speeding: Speeding,
    /// How its planner did.
    pub planning: Planning,
    /// What it believes of the others.
    pub beliefs: Beliefs,
    /// Its last state.
    pub last: State,
    /// Its way.
    route: Arc<Route>,
    /// Where that is along its way \[m\].
    along_m: f64,
}

impl VehicleMeasures {
    /// A vehicle at its start.
    fn new(vehicle: &Vehicle, start: State, scenario: &Scenario) -> Self {
        let mut measures = VehicleMeasures {
            completion: Completion::new(vehicle, &scenario.road),
            comfort: RideComfort::new(scenario.step_s),
            speed: SpeedRange::new(start.speed_mps),
            off_road: OffRoad::new(&vehicle.route, vehicle.body),
            speeding: Speeding::new(&vehicle.route),
            planning: Planning::new(scenario.plan_budget_ms(vehicle)),
            beliefs: Beliefs::default(),
            last: start,
            route: Arc::clone(&vehicle.route),
            along_m: vehicle.route.along(start.position()),
        };
        measures.look(&start, 0.0);
        measures
    }

    /// Looks at the state at one time.
    fn look(&mut self, state: &State, time_s: f64) {
        self.along_m = self.route.locate(state.position(), Some(self.along_m)).along_m;
        self.speed.observe(state.speed_mps);
        self.off_road.observe(state, self.along_m, time_s);
        self.speeding.observe(state.speed_mps, self.along_m, time_s);
        self.last = *state;
    }
}

impl Measures {
    /// Nothing measured yet.
    pub fn new(scenario: &Scenario) -> Self {
        let vehicles = scenario.vehicles.iter().zip(scenario.starts());
        let vehicles: Vec<VehicleMeasures> =
            vehicles.map(|(vehicle, start)| VehicleMeasures::new(vehicle, start, scenario)).collect();
        let along_m: Vec<f64> = vehicles.iter().map(|vehicle| vehicle.along_m).collect();
        Measures {
            collisions: Vec::new(),
            gap: SmallestGap::default(),
            time_to_collision: ShortestTimeToCollision::new(scenario),
            passages: Passages::new(scenario, &along_m),
            digest: Digest::default(),
            milestones: Milestones::new(scenario),
            vehicles,
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
        measured.beliefs.observe(&vehicle.plan.beliefs, frame.time_s);
        measured.comfort.observe(&vehicle.input, [&vehicle.state, state], frame.time_s);
        if measured.completion.observe(state, clock.time_s()) {
            frame.events.push(milestones::arrival(&vehicle.name, measured.completion.crosses()));
        }
        measured.look(state, clock.time_s());
    }
    let begun = measures.milestones.observe(frame);
    frame.events.extend(begun);
    measures.gap.observe(frame);
    measures.time_to_collision.observe(frame, &after);
    let along_m: Vec<f64> = measures.vehicles.iter().map(|vehicle| vehicle.along_m).collect();
    measures.passages.observe(&along_m, [frame.time_s, clock.time_s()]);
    measures.collisions.extend_from_slice(&frame.collisions);
    measures.digest.observe(frame, &after);
}
