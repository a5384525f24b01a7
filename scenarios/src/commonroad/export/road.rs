//! The exported road of a scenario that was not imported.

use super::base::Base;
use super::driven::{DrivenVehicle, VERSION};
use crate::model::scenario::Scenario;
use crate::roads::Road;

/// The roads of a scenario that was not imported.
pub(super) fn base(scenario: &Scenario, name: &str) -> Base {
    let benchmark = benchmark(name);
    let mut base = Base { attributes: attributes(scenario, &benchmark), benchmark, ..Base::default() };
    base.roads = "  <location><geoNameId>-999</geoNameId><gpsLatitude>999</gpsLatitude><gpsLongitude>999</gpsLongitude></location>\n  \
                  <scenarioTags><simulated/></scenarioTags>\n"
        .to_owned();
    match &scenario.network {
        Some(network) => base.add_network(network, scenario.ego()),
        None => base.parallel = Some(Box::new(scenario.clone())),
    }
    base.problem_id = base.ids.give(None);
    base
}

/// The same with roads as long as their driven part.
pub(super) fn around(base: &Base, vehicles: &[DrivenVehicle]) -> Base {
    let mut base = base.clone();
    if let Some(scenario) = base.parallel.take() {
        base.add_parallel(&scenario, vehicles);
    }
    base
}

/// A benchmark name in the form that CommonRoad requires.
fn benchmark(name: &str) -> String {
    let letters: String = name.trim_end_matches(".toml").chars().filter(char::is_ascii_alphanumeric).take(60).collect();
    format!("ZAM_{}-1_1_T-1", if letters.is_empty() { "Scenario".to_owned() } else { letters })
}

fn attributes(scenario: &Scenario, benchmark: &str) -> Vec<(String, String)> {
    let step_s = scenario.step_s.to_string();
    let all = [
        ("timeStepSize", step_s.as_str()),
        ("commonRoadVersion", VERSION),
        ("benchmarkID", benchmark),
        ("author", "Interplay"),
        ("affiliation", "Interplay"),
        (
            "source",
            if matches!(scenario.road, Road::Network(_)) { "a network of lanes" } else { "a scenario of Interplay" },
        ),
        ("date", "2000-01-01"),
    ];
    all.map(|(name, value)| (name.to_owned(), value.to_owned())).to_vec()
}
