//! The legend below a picture: which colour is which vehicle, or which flow.

use interplay_scenarios::Scenario;

use super::camera::WIDTH_PX;
use super::caption::MARGIN_PX;
use super::letters::width_of;

/// Size of its words \[px\].
pub const TEXT_PX: f64 = 14.0;

/// A row of the legend: index, text and left end \[px\] of each entry.
pub type LegendRow = Vec<(usize, String, f64)>;

/// The rows of a legend with names and drivers of some vehicles.
pub fn of_vehicles(scenario: &Scenario, listed: &[usize]) -> Vec<LegendRow> {
    let described = |index: &usize| {
        let vehicle = &scenario.vehicles[*index];
        (*index, format!("{}: {}", vehicle.name, vehicle.driver.description()))
    };
    in_rows(listed.iter().map(described))
}

/// Entries of a legend, by index and words, in rows.
fn in_rows(entries: impl Iterator<Item = (usize, String)>) -> Vec<LegendRow> {
    let mut rows: Vec<LegendRow> = vec![Vec::new()];
    let mut left = MARGIN_PX;
    for (index, words) in entries {
        let wide = 23.0 + width_of(&format!("{words} 00.0 m/s"), TEXT_PX) + 20.0;
        if left + wide > WIDTH_PX && left > MARGIN_PX {
            rows.push(Vec::new());
            left = MARGIN_PX;
        }
        if let Some(row) = rows.last_mut() {
            row.push((index, words, left));
        }
        left += wide;
    }
    rows
}

/// The rows of a legend with the flows of which some vehicles come, each with the colour of its first vehicle.
pub fn of_flows(scenario: &Scenario, listed: &[usize]) -> Vec<LegendRow> {
    let flow_of = |index: usize| scenario.flows.of(&scenario.vehicles[index].name);
    let described = |name: &str| {
        let mut vehicles = listed.iter().copied().filter(|index| flow_of(*index) == Some(name));
        let first = vehicles.next()?;
        Some((first, format!("{name}: {} vehicles", 1 + vehicles.count())))
    };
    in_rows(scenario.flows.names().filter_map(described))
}
