//! All pictures of one run, whatever it is of.

use super::entry::FigureContent;
use super::recorded_run::RecordedRun;
use super::space_time::space_time;
use super::{climate, driving, measures};
use crate::plot::TextTable;

/// Of so many vehicles, what each believes and intends is drawn; of more, of the ego alone.
const MOST_EXPLAINED: usize = 16;

/// Everything there is to see of a run: footprints, speeds and gaps, each planner's own numbers; for a building
/// temperatures, inputs, costs and weather; and what was measured and expected.
pub(super) fn show(recorded: &RecordedRun) -> FigureContent {
    let mut content = FigureContent::default();
    if !recorded.scenario.vehicles.is_empty() {
        // Neither footprints nor speeds of a crowd are drawn one by one.
        if !recorded.scenario.is_crowd() {
            content.pictures.push(driving::footprints("Footprints at equal steps of time", recorded).drawing());
            content.pictures.push(driving::motion("Speeds, gap and accelerations", recorded).drawing());
        }
        content.pictures.extend(space_time("Where everybody is over time", recorded).map(|panels| panels.drawing()));
        let (ego, vehicles) = (recorded.scenario.ego_index(), &recorded.scenario.vehicles);
        let explained = vehicles.iter().enumerate();
        for (index, vehicle) in explained.filter(|(index, _)| vehicles.len() <= MOST_EXPLAINED || *index == ego) {
            let title =
                format!("What the planner of {} ({}) believes and intends", vehicle.name, vehicle.driver.kind());
            content.pictures.extend(driving::reasons(&title, recorded, index).map(|panels| panels.drawing()));
        }
    }
    if recorded.report.building.is_some() {
        let zones = climate::first_zones(recorded);
        content.pictures.push(climate::temperatures("Temperatures, day by day", recorded, &zones).drawing());
        content.pictures.push(climate::inputs("Heat from the equipment, day by day", recorded, &zones).drawing());
        content.pictures.push(climate::costs("Cost of each day", &[recorded]).drawing());
        content.pictures.push(climate::weather(weather_title(recorded), recorded).drawing());
    }
    // Of one run, a measure a row: a row of all measures is wider than a page.
    content.tables = measures::side_by_side(&[recorded]).into_iter().map(TextTable::transposed).collect();
    content.tables.extend(recorded.report.building.as_ref().map(measures::zones));
    if !recorded.report.expectations.is_empty() {
        content.tables.push(measures::expected(&recorded.report));
    }
    if !recorded.report.counterfactuals.is_empty() {
        content.tables.push(measures::counterfactuals(&recorded.report));
    }
    content
}

fn weather_title(recorded: &RecordedRun) -> &'static str {
    let has_price = recorded.report.building.as_ref().is_some_and(|building| building.currency.is_some());
    if has_price { "Weather and price of electricity" } else { "Weather" }
}
