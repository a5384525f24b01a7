//! Time to compute a plan of a vehicle, by its driver and the number of others.
//!
//! ```text
//! time = alone · (1 + share · others) · stages / 30 · (people) · (inference)
//! ```
//!
//! [`DriverKind::plan_time`](interplay_planners::DriverKind::plan_time) returns the first two, which were fitted to 324 random runs (an authored
//! scenario, often with another planner or horizon). The two factors were set afterwards, from the runs with the largest errors.

use interplay_planners::prediction::Prediction;

use crate::model::scenario::{Scenario, Vehicle};

/// Stages of the plans that were measured.
const USUAL_STAGES: f64 = 30.0;
/// More vehicles than this are seldom near enough to add time.
const MOST_OTHERS: usize = 12;
/// Human drivers keep more rules and look more often.
const PEOPLE_FACTOR: f64 = 2.5;
/// A driver that infers plans considers several motions of each other vehicle.
const INFERENCE_FACTOR: f64 = 3.0;

/// Processor time of a plan of a vehicle \[s\].
pub(super) fn plan_time_s(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
    let others = scenario.vehicles.len().saturating_sub(1).min(MOST_OTHERS) as f64;
    let time = vehicle.driver.plan_time();
    let people = if vehicle.limits.comfort.is_some() { PEOPLE_FACTOR } else { 1.0 };
    let inference = if vehicle.driver.prediction() == Some(Prediction::Inferred) { INFERENCE_FACTOR } else { 1.0 };
    let alone_s = time.alone_s * scenario.horizon_steps as f64 / USUAL_STAGES;
    alone_s * (1.0 + time.share_of_each_other * others) * people * inference
}
