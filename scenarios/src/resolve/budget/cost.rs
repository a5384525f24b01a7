//! The cost of a run.

use std::fmt;

use super::plan_time::plan_time_s;
use crate::model::derived::crowd::MOST_TOLD;
use crate::model::scenario::{Scenario, Vehicle};
use crate::model::traffic::plant::Plant;

/// Size of a recording of nothing: the blueprint, descriptions and the road \[bytes\].
const EMPTY_RECORDING_BYTES: f64 = 500e3;
/// What each stage of a plan adds to a recording; 30 stages were measured to take 0.9 kB \[bytes\].
const BYTES_PER_STAGE: f64 = 30.0;
/// What each tick of a vehicle adds \[bytes\].
const BYTES_PER_TICK: f64 = 60.0;
/// What each step of a building adds, and each zone in it \[bytes\].
const BYTES_PER_BUILDING_STEP: f64 = 500.0;
const BYTES_PER_ZONE_STEP: f64 = 20.0;
/// In buildings of up to this many zones each zone has plots of its own, in larger ones four zones.
const MAX_PLOTTED_ZONES: usize = 16;
const PLOTTED_ZONES_OF_MANY: usize = 4;
/// What the plots of a zone add, and each step in them \[bytes\].
const BYTES_PER_PLOTTED_ZONE: f64 = 50e3;
const BYTES_PER_PLOTTED_ZONE_STEP: f64 = 150.0;

/// Time of a step, and of an operation of a design \[s\].
const SECONDS_PER_STEP: f64 = 2e-7;
const SECONDS_PER_OPERATION: f64 = 1e-9;

/// The most other vehicles near a vehicle in dense traffic.
const MOST_NEAR: u64 = 80;

/// The cost of a run: counts are exact, operations and bytes are estimates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunCost {
    /// Plans of vehicles, at most: a vehicle that leaves early makes fewer.
    pub plans: u64,
    /// Steps of bodies, pairs of bodies, and zones.
    pub steps: u64,
    /// Time points that are recorded; those of vehicles and building may coincide.
    pub records: u64,
    /// Operations of the designs of the building's days, in billions.
    pub design_gop: f64,
    /// Time of one core of the reference machine, with all plans, steps and designs \[s\].
    pub processor_s: f64,
    /// Size of the recording \[MB\].
    pub recorded_mb: f64,
}

impl RunCost {
    /// The cost of a scenario without its counterfactuals.
    pub(crate) fn estimate(scenario: &Scenario) -> RunCost {
        let (vehicles, ticks) = (scenario.vehicles.len() as u64, scenario.tick_count() as u64);
        let plans = scenario.vehicles.iter().map(|vehicle| plans_of(scenario, vehicle)).sum();
        // Of many vehicles, each only considers those near it.
        let bodies_and_pairs = vehicles * (vehicles.min(MOST_NEAR) + 1) / 2;
        let sub_steps = match scenario.plant {
            Plant::Kinematic(_) => 1,
            Plant::Dynamic(_) => Plant::sub_steps(scenario.step_s) as u64,
        };
        let zones = scenario.building.as_ref().map_or(0, |building| building.zone_count());
        let steps_per_day = scenario.building.as_ref().map_or(0, |building| building.steps_per_day());
        let building_steps = (scenario.days() * steps_per_day) as u64;
        let operations =
            scenario.controller().operations_per_day(zones as f64, steps_per_day as f64) * scenario.days() as f64;
        let zone_steps = building_steps.saturating_mul(zones as u64);
        let planning_s: f64 = scenario
            .vehicles
            .iter()
            .map(|vehicle| plans_of(scenario, vehicle) as f64 * plan_time_s(scenario, vehicle))
            .sum();
        let steps = ticks.saturating_mul(sub_steps).saturating_mul(bodies_and_pairs).saturating_add(zone_steps);
        let bytes = EMPTY_RECORDING_BYTES
            + vehicles_bytes(scenario, plans, ticks)
            + building_steps as f64 * BYTES_PER_BUILDING_STEP
            + zone_steps as f64 * BYTES_PER_ZONE_STEP
            + plots_bytes(zones, building_steps);
        RunCost {
            plans,
            steps,
            records: ticks + building_steps,
            design_gop: operations / 1e9,
            processor_s: planning_s + steps as f64 * SECONDS_PER_STEP + operations * SECONDS_PER_OPERATION,
            recorded_mb: bytes / 1e6,
        }
    }

    /// Both runs; counterfactuals are not recorded.
    pub(crate) fn with_unrecorded(self, other: RunCost) -> RunCost {
        RunCost {
            plans: self.plans.saturating_add(other.plans),
            steps: self.steps.saturating_add(other.steps),
            design_gop: self.design_gop + other.design_gop,
            processor_s: self.processor_s + other.processor_s,
            ..self
        }
    }
}

/// What vehicles add to a recording of `plans` plans and `ticks` ticks \[bytes\].
fn vehicles_bytes(scenario: &Scenario, plans: u64, ticks: u64) -> f64 {
    let planned = plans as f64 * scenario.horizon_steps as f64 * BYTES_PER_STAGE;
    if !scenario.is_crowd() {
        return planned;
    }
    // Of a crowd, about `MOST_TOLD` vehicles are near the ego.
    let vehicles = scenario.vehicles.len() as f64;
    planned * MOST_TOLD as f64 / vehicles + ticks as f64 * vehicles * BYTES_PER_TICK
}

/// The most plans of a vehicle, from when it enters.
fn plans_of(scenario: &Scenario, vehicle: &Vehicle) -> u64 {
    let absent_share = vehicle.stay.enters_s.unwrap_or(0.0) / scenario.duration_s;
    (scenario.plan_count() as f64 * (1.0 - absent_share).max(0.0)).ceil() as u64
}

/// What plots of single zones add to a recording \[bytes\].
fn plots_bytes(zones: usize, building_steps: u64) -> f64 {
    let plotted = if zones <= MAX_PLOTTED_ZONES { zones } else { PLOTTED_ZONES_OF_MANY };
    plotted as f64 * (BYTES_PER_PLOTTED_ZONE + building_steps as f64 * BYTES_PER_PLOTTED_ZONE_STEP)
}

impl Scenario {
    /// The cost of a run of the scenario, including its counterfactuals, which are not recorded.
    pub fn cost(&self) -> RunCost {
        self.own_cost().with_unrecorded(self.counterfactual_cost())
    }

    /// The cost of the scenario's own run.
    pub fn own_cost(&self) -> RunCost {
        RunCost::estimate(self)
    }

    /// The cost of its counterfactuals, which are not recorded.
    pub fn counterfactual_cost(&self) -> RunCost {
        let others = self.counterfactuals.iter().map(|other| RunCost::estimate(&other.scenario));
        others.fold(RunCost::default(), RunCost::with_unrecorded)
    }
}

/// On one line, in words; zero counts are left out.
impl fmt::Display for RunCost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.plans > 0 {
            write!(f, "{} plans, ", self.plans)?;
        }
        write!(f, "{} steps, ", self.steps)?;
        if self.design_gop >= 0.05 {
            write!(f, "{:.1} billion operations of design, ", self.design_gop)?;
        }
        if self.records > 0 {
            write!(f, "{} records in about {:.1} MB, ", self.records, self.recorded_mb)?;
        }
        match self.processor_s {
            short if short < 10.0 => write!(f, "about {short:.1} s of a processor"),
            long => write!(f, "about {long:.0} s of a processor"),
        }
    }
}
