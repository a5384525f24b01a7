//! The outcome for a building.

use interplay_building::day::ZoneFigures;
use interplay_scenarios::Scenario;
use serde::Serialize;

use crate::measure::{BuildingDigests, BuildingMeasures, Fallback};
use crate::plants::Benchmark;
use crate::state::day::DayFigures;
use crate::state::whole_run::WholeRun;

/// The outcome for a building.
#[derive(Clone, Debug, Serialize)]
pub struct BuildingReport {
    /// The kind of its controller.
    pub controller: String,
    /// Number of zones.
    pub zones: usize,
    /// The names of the zones.
    #[serde(skip)]
    pub zone_names: Vec<String>,
    /// Digests of the results of each part of the phase Climate.
    pub digests: BuildingDigests,
    /// Settings that are allowed but may be unintended, such as zones without heat exchange.
    pub remarks: Vec<String>,
    /// The days on which the controller had no plan of its own, and why.
    pub fallbacks: Vec<Fallback>,
    /// The days whose feedback has a weaker certificate than requested, and why.
    pub weaker_feedbacks: Vec<Fallback>,
    /// The currency of costs; none without a tariff.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub currency: Option<String>,
    /// All days compared with the cheapest run with perfect foresight; none for a foreign plant or a large building.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub whole_run: Option<WholeRun>,
    /// The indicators of the benchmark as the plant, its own and ours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub benchmark: Option<Benchmark>,
    /// Every day.
    pub iterations: Vec<DayFigures>,
    /// Every zone, in the order of the scenario.
    pub zone_figures: Vec<ZoneOutcome>,
}

/// The outcome for a zone.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZoneOutcome {
    /// Its name.
    pub zone: String,
    /// Every day.
    pub iterations: Vec<ZoneFigures>,
}

impl BuildingReport {
    /// Builds the outcome from the measures.
    pub fn new(scenario: &Scenario, measures: &BuildingMeasures) -> Self {
        BuildingReport {
            controller: scenario.controller().kind().to_owned(),
            zones: measures.zones,
            zone_names: measures.zone_names.clone(),
            digests: measures.digests(),
            remarks: measures.remarks.clone(),
            fallbacks: measures.fallbacks.clone(),
            weaker_feedbacks: measures.weaker_feedbacks.clone(),
            currency: measures.currency.clone(),
            whole_run: measures.whole_run(),
            benchmark: measures.benchmark.clone(),
            iterations: measures.days.clone(),
            zone_figures: zone_figures(measures),
        }
    }
}

/// The figures of the days, zone by zone.
fn zone_figures(measures: &BuildingMeasures) -> Vec<ZoneOutcome> {
    let zones = measures.zone_names.iter().enumerate();
    zones
        .map(|(index, zone)| {
            let iterations = measures.zone_days.iter().map(|zones| zones[index]).collect();
            ZoneOutcome { zone: zone.clone(), iterations }
        })
        .collect()
}
