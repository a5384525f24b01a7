//! Measures of a run: metrics, which are declared once (`metrics`), and measures of other forms.
//!
//! A [`Metric`] has one value for a vehicle or a run. Other measures do not: reaching a goal is also an event, plans are counted and
//! timed together, the right of way is a list of pairs, beliefs and digests are not numbers, and a building is measured day by day.

mod broken_rules;
mod building;
mod completion;
mod digest;
mod fault;
mod lane_use;
mod metric;
mod metrics;
mod milestones;
mod planning;
mod rectangle;
mod registered;
mod right_of_way;
mod subscriptions;
mod travel;
mod values;
mod vehicle_metric;
mod waits;

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::{Input, State};
use interplay_scenarios::{MetricDeclaration, MetricSubject, Scenario, Vehicle};

pub use broken_rules::BrokenRules;
pub use building::{BuildingDigests, BuildingMeasures, Fallback, measure_building};
pub use completion::Completion;
pub use digest::{Digest, PhaseDigests};
pub use fault::Faults;
pub use metric::{
    Measurement, Metric, MomentStates, Needs, ObservedMoment, ObservedTick, SharedStates, VehicleMoment, VehicleTick,
};
pub use metrics::beyond_edge_m;
pub(crate) use metrics::time_gap_s;
pub use milestones::{Milestones, is_arrival};
pub use planning::{Beliefs, HeldBelief, Planning};
pub use registered::{RegisterMetrics, metric_table, metrics_of};
pub use right_of_way::{Passage, Passages};
pub use subscriptions::Subscriptions;
pub use travel::Travel;
pub use values::{Measured, MetricValue, MetricValues};
pub use vehicle_metric::{Fold, LeastOfRun, VehicleMetric, VehicleQuantity};
pub use waits::{Deadlock, Wait, Waits};

use crate::state::components::{Clock, CurrentFrame, CurrentTraffic, MeasuredParts};
use crate::state::frame::{Collision, Frame};
use crate::state::standing::Standing;

/// All measures of a run.
#[derive(Resource, Clone, Debug)]
pub struct Measures {
    /// Contacts, in order.
    pub collisions: Vec<Collision>,
    /// Which vehicle went first where routes cross or merge.
    pub passages: Passages,
    /// Which vehicle is at fault where two touch or come too near.
    pub faults: Faults,
    /// The rules of the road that were broken.
    pub broken_rules: BrokenRules,
    /// Digest of the run, by phase.
    pub digest: Digest,
    /// Events for the log.
    pub milestones: Milestones,
    /// Stationary vehicles, their reasons, and deadlocks.
    pub waits: Waits,
    /// Metrics of the run.
    pub metrics: Measurements,
    /// Per vehicle, in the scenario's order.
    pub vehicles: Vec<VehicleMeasures>,
    /// The vehicles as the scenario states them.
    stated: Arc<[Vehicle]>,
    /// What is measured.
    subscriptions: Subscriptions,
    /// What the measurements need.
    needs: Needs,
    /// Arc lengths of the vehicles on their routes \[m\].
    along_m: Vec<f64>,
    /// Their inputs of the tick before.
    previous_inputs: Vec<Input>,
    /// Their states at the end of the tick; memory for the next one.
    after: Vec<State>,
}

/// All measures of one vehicle.
#[derive(Clone, Debug)]
pub struct VehicleMeasures {
    /// When it reached its goal.
    pub completion: Completion,
    /// Measures of its planner.
    pub planning: Planning,
    /// Its beliefs about the others.
    pub beliefs: Beliefs,
    /// Its metrics.
    pub metrics: Measurements,
    /// How it travels.
    pub travel: Travel,
    /// Its last state.
    pub last: State,
}

/// Metrics that are being measured, in the order in which they are listed.
#[derive(Clone, Debug)]
pub struct Measurements(Vec<(MetricDeclaration, Box<dyn Measurement>)>);

impl Measurements {
    /// Begins to measure a vehicle or the run.
    fn begin(
        (scenario, subscriptions): (&Scenario, &Subscriptions),
        of: MetricSubject,
        start: &ObservedMoment<'_>,
        vehicle: usize,
    ) -> Self {
        let of_subject = metrics_of(&scenario.metrics).filter(|metric| metric.declaration().of == of);
        let subscribed = of_subject.filter(|metric| subscriptions.includes(*metric, vehicle));
        let begun = subscribed.map(|metric| (metric.declaration(), metric.begin(scenario, start, vehicle)));
        Measurements(begun.collect())
    }

    fn observe(&mut self, tick: &ObservedTick<'_>) {
        self.0.iter_mut().for_each(|(_, measurement)| measurement.observe(tick));
    }

    /// A present value as a number; 0 if it is not measured.
    pub fn number(&self, name: &str) -> f64 {
        let found = self.0.iter().find(|(declaration, _)| declaration.name == name);
        found.and_then(|(_, measurement)| measurement.measured().value).map_or(0.0, |value| value.as_number())
    }

    /// The present values.
    pub fn values(&self) -> MetricValues {
        let measured = |(declaration, measurement): &(MetricDeclaration, Box<dyn Measurement>)| {
            (*declaration, measurement.measured().of_kind(declaration.kind))
        };
        MetricValues(self.0.iter().map(measured).collect())
    }
}

impl Measures {
    /// Arc lengths of the vehicles on their routes \[m\].
    pub fn along_m(&self) -> &[f64] {
        &self.along_m
    }

    /// Begins with nothing measured.
    pub fn new(scenario: &Scenario, subscriptions: &Subscriptions) -> Self {
        let starts = scenario.starts();
        let located = |vehicle: &Vehicle, start: &State| {
            let along_m = vehicle.route.along(start.position());
            vehicle.route.locate(start.position(), Some(along_m)).along_m
        };
        let along_m: Vec<f64> =
            scenario.vehicles.iter().zip(&starts).map(|(vehicle, start)| located(vehicle, start)).collect();
        let start = ObservedMoment { time_s: 0.0, vehicles: &scenario.vehicles, states: &starts, along_m: &along_m };
        let subscribed = (scenario, subscriptions);
        let vehicles = scenario.vehicles.iter().enumerate().map(|(index, vehicle)| VehicleMeasures {
            completion: Completion::new(vehicle, &scenario.road),
            planning: Planning::new(scenario.plan_budget_ms(vehicle)),
            beliefs: Beliefs::default(),
            metrics: Measurements::begin(subscribed, MetricSubject::Vehicle, &start, index),
            travel: Travel::new(vehicle),
            last: starts[index],
        });
        let metrics = match scenario.vehicles.as_slice() {
            [] => Measurements(Vec::new()),
            [_, ..] => Measurements::begin(subscribed, MetricSubject::Run, &start, scenario.ego_index()),
        };
        Measures {
            collisions: Vec::new(),
            passages: if subscriptions.is_everything() {
                Passages::new(scenario, &along_m)
            } else {
                Passages::default()
            },
            faults: Faults::new(&scenario.vehicles, scenario.ego_index()),
            broken_rules: BrokenRules::new(scenario, &start),
            digest: Digest::default(),
            milestones: Milestones::new(scenario),
            waits: Waits::new(scenario),
            metrics,
            vehicles: vehicles.collect(),
            stated: scenario.vehicles.clone().into(),
            subscriptions: subscriptions.clone(),
            needs: subscriptions.needs(metrics_of(&scenario.metrics)),
            previous_inputs: vec![Input::default(); scenario.vehicles.len()],
            along_m,
            after: Vec::new(),
        }
    }
}

/// Adds the tick's frame and the states at its end to every measure.
pub fn measure(
    traffic: Res<CurrentTraffic>,
    clock: Res<Clock>,
    mut current_frame: ResMut<CurrentFrame>,
    mut measures: ResMut<Measures>,
) {
    let mut after = std::mem::take(&mut measures.after);
    after.clear();
    after.extend(traffic.0.road_users.iter().map(|user| user.agent.state));
    measures.observe(&mut current_frame.0, &after, &clock);
    measures.after = after;
}

impl Measures {
    fn observe(&mut self, frame: &mut Frame, after: &[State], clock: &Clock) {
        let measures = self;
        let (is_everything, needs) = (measures.subscriptions.is_everything(), measures.needs);
        measures.note_progress(frame, after, clock.time_s());
        if is_everything {
            measures.note_conduct(frame, clock.step_s);
        }
        for ((along_m, vehicle), state) in measures.along_m.iter_mut().zip(&*measures.stated).zip(after) {
            *along_m = vehicle.route.locate(state.position(), Some(*along_m)).along_m;
        }
        if needs.faults {
            measures.faults.observe(frame, after, clock.step_s);
        }
        let end = ObservedMoment {
            time_s: clock.time_s(),
            vehicles: &measures.stated,
            states: after,
            along_m: &measures.along_m,
        };
        if needs.broken_rules {
            frame.broken_rules = measures.broken_rules.observe(frame, &end);
            frame.events.extend(frame.broken_rules.iter().map(broken_rules::event));
        }
        let (step_s, previous_inputs) = (clock.step_s, measures.previous_inputs.as_slice());
        let shared = SharedStates::default();
        let tick = ObservedTick { frame, step_s, shared: &shared, previous_inputs, end };
        measures.metrics.observe(&tick);
        for (measured, vehicle) in measures.vehicles.iter_mut().zip(&frame.vehicles) {
            if !vehicle.is_absent {
                measured.metrics.observe(&tick);
            }
        }
        measures.collisions.extend_from_slice(&frame.collisions);
        if is_everything {
            let speeds_mps: Vec<f64> = after.iter().map(|state| state.speed_mps).collect();
            measures.passages.observe(&measures.along_m, &speeds_mps, [frame.time_s, clock.time_s()]);
            measures.digest.observe(frame, after);
        } else {
            measures.digest.observe_states(frame, after);
        }
        for (previous, vehicle) in measures.previous_inputs.iter_mut().zip(&frame.vehicles) {
            *previous = vehicle.input;
        }
    }

    /// Which vehicles have reached their goals, and where each is.
    fn note_progress(&mut self, frame: &mut Frame, after: &[State], time_s: f64) {
        let with_states = frame.vehicles.iter().zip(&mut self.vehicles).zip(after).enumerate();
        for (index, ((vehicle, measured), state)) in with_states.filter(|(_, ((vehicle, _), _))| !vehicle.is_absent) {
            if self.subscriptions.has(index) && measured.completion.observe(state, time_s) {
                frame.events.push(milestones::arrival(&vehicle.name, measured.completion.crosses()));
            }
            measured.last = *state;
        }
    }

    /// How the vehicles plan, travel and wait, with the events of the log.
    fn note_conduct(&mut self, frame: &mut Frame, step_s: f64) {
        for (vehicle, measured) in frame.vehicles.iter().zip(&mut self.vehicles) {
            if frame.plans && !vehicle.is_absent {
                measured.planning.observe(vehicle);
            }
            if !vehicle.is_absent {
                measured.beliefs.observe(&vehicle.plan.beliefs, frame.time_s);
            }
            measured.travel.observe(vehicle, step_s);
        }
        let begun = self.milestones.observe(frame);
        frame.events.extend(begun);
        let stuck = self.waits.observe(&Standing::of(&self.stated, frame), frame, step_s);
        frame.events.extend(stuck);
    }

    /// The parts of a tick that are measured.
    pub(crate) fn parts(&self) -> MeasuredParts {
        MeasuredParts { gaps: self.needs.gaps, plans: self.subscriptions.is_everything() }
    }
}
