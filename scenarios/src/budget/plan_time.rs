//! How long a plan takes: measured, by kind of driver.
//!
//! ```text
//! time = base · (1 + slope · others) · stages / 30 · (people) · (inference) · (global search)
//! ```
//!
//! The times and slopes were fitted to 324 random runs (an authored scenario, often with another planner or horizon) on one core of the
//! reference machine, an AMD EPYC at 2.6 GHz; 94 % of those took between a third of the time and three times as long. The factors for
//! people, inference and a global search were set afterwards, by the runs that were farthest off and by five runs with such a search.
//! `tests/peers/plan_times.py` compares all of it with other runs.

use interplay_planners::predict::Prediction;

use crate::scenario::{Scenario, Vehicle};

/// Kind of driver, time of a plan of 30 stages with nobody near \[s\], and by which share of it each other vehicle near makes it longer.
const TIMES: [(&str, f64, f64); 8] = [
    ("human", 0.27e-3, 0.09),
    ("conservative", 0.47e-3, 0.02),
    ("cooperative", 0.44e-3, 0.02),
    ("negotiation", 1.0e-3, 0.27),
    ("bayesian", 0.32e-3, 0.05),
    ("game", 0.42e-3, 0.4),
    ("nash", 1.4e-3, 0.34),
    ("contingency", 0.12e-3, 26.0),
];
/// Time of a plan of all who do not optimise \[s\].
const SIMPLE_S: f64 = 25e-6;
/// Kinds of other crates are taken for one that optimises.
const FOREIGN_S: f64 = 1e-3;
const SIMPLE_KINDS: [&str; 6] = ["idm", "scripted", "recorded", "walker", "external", "inputs"];
/// Stages of the plans that were measured.
const USUAL_STAGES: f64 = 30.0;
/// More others than these are seldom near enough to take time.
const MOST_OTHERS: usize = 12;
/// People keep more rules, and look more often; who infers thinks of several motions of each other; and a global search tries
/// all passing orders.
const PEOPLE_FACTOR: f64 = 2.5;
const INFERENCE_FACTOR: f64 = 3.0;
const GLOBAL_SEARCH_FACTOR: f64 = 1000.0;

/// Processor time of a plan of a vehicle \[s\].
pub(super) fn plan_time_s(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
    let kind = vehicle.driver.kind();
    if SIMPLE_KINDS.contains(&kind) {
        return SIMPLE_S;
    }
    let others = scenario.vehicles.len().saturating_sub(1).min(MOST_OTHERS) as f64;
    let known = TIMES.iter().find(|(known, ..)| *known == kind);
    let base_s = known.map_or(FOREIGN_S, |(_, base_s, slope)| base_s * (1.0 + slope * others));
    let factors = [
        (vehicle.limits.comfort.is_some(), PEOPLE_FACTOR),
        (vehicle.driver.prediction() == Some(Prediction::Inferred), INFERENCE_FACTOR),
        (searches_globally(vehicle), GLOBAL_SEARCH_FACTOR),
    ];
    let factor: f64 = factors.iter().filter(|(applies, _)| *applies).map(|(_, factor)| factor).product();
    base_s * factor * scenario.horizon_steps as f64 / USUAL_STAGES
}

/// Whether the settings say `passing_orders = "global"`.
fn searches_globally(vehicle: &Vehicle) -> bool {
    let settings = serde_json::to_value(&vehicle.driver).ok();
    settings.is_some_and(|settings| settings.get("passing_orders").is_some_and(|orders| orders == "global"))
}
