//! The interface of a metric: its declaration, and its computation from the ticks of a run.

use std::cell::RefCell;
use std::fmt::Debug;
use std::sync::Arc;

use interplay_planners::{Input, State};
use interplay_scenarios::{MetricDeclaration, Scenario, Vehicle};

use super::values::Measured;
use crate::state::frame::{Frame, VehicleFrame};

/// A metric. It is declared once: reports, rows of sweeps, comparisons, expectations and the reference follow.
///
/// A metric that is folded over the ticks of a vehicle, such as a peak or a mean, need not implement this trait:
/// [`VehicleMetric`](super::VehicleMetric) does.
pub trait Metric: Debug + Send + Sync {
    /// Its declaration.
    fn declaration(&self) -> MetricDeclaration;

    /// Begins to measure one run, with all vehicles at their starts. `vehicle` is the index of the measured vehicle; for a metric
    /// of the run, that of the ego.
    fn begin(&self, scenario: &Scenario, start: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement>;

    /// What it reads of a tick besides states, inputs and contacts. A run that does not subscribe to any metric with a need does not make
    /// that part of its frames.
    fn needs(&self) -> Needs {
        Needs::EVERYTHING
    }

    /// Distinguishes its values from those of earlier versions: rows of sweeps with another version are made again.
    fn version(&self) -> &'static str {
        ""
    }
}

/// What of the frames a measurement reads besides states, inputs and contacts.
///
/// A part that no subscribed measurement needs is not made: its fields of the frame are empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The distances between footprints.
    pub gaps: bool,
    /// The rules of the road that are broken.
    pub broken_rules: bool,
    /// The vehicles at fault in contacts, and gaps that are cut short.
    pub faults: bool,
}

impl Needs {
    /// All parts.
    pub const EVERYTHING: Needs = Needs { gaps: true, broken_rules: true, faults: true };

    /// No part: states, inputs and contacts suffice.
    pub const STATES: Needs = Needs { gaps: false, broken_rules: false, faults: false };

    /// The parts that either needs.
    #[must_use]
    pub fn and(self, other: Needs) -> Needs {
        Needs {
            gaps: self.gaps || other.gaps,
            broken_rules: self.broken_rules || other.broken_rules,
            faults: self.faults || other.faults,
        }
    }
}

/// The measurement of a metric in one run.
pub trait Measurement: Debug + Send + Sync {
    /// Takes one tick.
    fn observe(&mut self, tick: &ObservedTick<'_>);

    /// The result so far.
    fn measured(&self) -> Measured;

    /// An independent copy, for a snapshot of the run.
    fn fork(&self) -> Box<dyn Measurement>;
}

/// All vehicles at one time, in the scenario's order.
#[derive(Clone, Copy, Debug)]
pub struct ObservedMoment<'a> {
    /// Simulated time \[s\].
    pub time_s: f64,
    /// The vehicles as the scenario states them.
    pub vehicles: &'a [Vehicle],
    /// Their states.
    pub states: &'a [State],
    /// Arc lengths of their mass centres on their routes \[m\].
    pub along_m: &'a [f64],
}

/// States of all vehicles at several times within a tick, computed once for all metrics.
#[derive(Debug, Default)]
pub struct SharedStates(RefCell<Vec<(usize, Arc<[MomentStates]>)>>);

/// The states of all vehicles at one time, in the scenario's order; none for a vehicle that is not on the road.
pub type MomentStates = Arc<[Option<State>]>;

/// One tick.
#[derive(Clone, Copy, Debug)]
pub struct ObservedTick<'a> {
    /// The start of the tick, the decisions, and the contacts.
    pub frame: &'a Frame,
    /// Its length \[s\].
    pub step_s: f64,
    /// Values that metrics of several vehicles share in this tick.
    pub shared: &'a SharedStates,
    /// The inputs of the tick before, in the scenario's order; zero in the first.
    pub previous_inputs: &'a [Input],
    /// The end of the tick.
    pub end: ObservedMoment<'a>,
}

/// One vehicle at one time.
#[derive(Clone, Copy, Debug)]
pub struct VehicleMoment<'a> {
    /// Simulated time \[s\].
    pub time_s: f64,
    /// The vehicle as the scenario states it.
    pub vehicle: &'a Vehicle,
    /// Its state.
    pub state: &'a State,
    /// Arc length of its mass centre on its route \[m\].
    pub along_m: f64,
}

/// One vehicle during one tick.
#[derive(Clone, Copy, Debug)]
pub struct VehicleTick<'a> {
    /// Its state before, its plan and its input.
    pub frame: &'a VehicleFrame,
    /// Its input of the tick before; zero in the first.
    pub previous_input: Input,
    /// Length of the tick \[s\].
    pub step_s: f64,
    /// The end of the tick.
    pub end: VehicleMoment<'a>,
}

impl<'a> ObservedMoment<'a> {
    /// One vehicle at this time.
    pub fn of(&self, vehicle: usize) -> VehicleMoment<'a> {
        VehicleMoment {
            time_s: self.time_s,
            vehicle: &self.vehicles[vehicle],
            state: &self.states[vehicle],
            along_m: self.along_m[vehicle],
        }
    }
}

impl<'a> ObservedTick<'a> {
    /// One vehicle in this tick.
    pub fn of(&self, vehicle: usize) -> VehicleTick<'a> {
        VehicleTick {
            frame: &self.frame.vehicles[vehicle],
            previous_input: self.previous_inputs[vehicle],
            step_s: self.step_s,
            end: self.end.of(vehicle),
        }
    }
}

impl Clone for Box<dyn Measurement> {
    fn clone(&self) -> Self {
        self.fork()
    }
}

impl ObservedTick<'_> {
    /// The states of all vehicles at the ends of `parts` equal parts of the tick, in order.
    pub(crate) fn states_within(&self, parts: usize) -> Arc<[MomentStates]> {
        let mut known = self.shared.0.borrow_mut();
        if let Some((_, states)) = known.iter().find(|(known, _)| *known == parts) {
            return Arc::clone(states);
        }
        let at = |share: f64| -> MomentStates {
            let moved = self.frame.vehicles.iter().zip(self.end.states);
            moved.map(|(from, to)| (!from.is_absent).then(|| from.state.towards(to, share))).collect()
        };
        let states: Arc<[MomentStates]> = (1..=parts).map(|part| at(part as f64 / parts as f64)).collect();
        known.push((parts, Arc::clone(&states)));
        states
    }
}
