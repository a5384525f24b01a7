//! All pictures of one run, whatever it is of.

use super::entry::Exhibit;
use super::take::Take;
use super::{climate, driving, measures};

/// Everything there is to see of a run: footprints, speeds and gaps, each planner's own numbers; for a building
/// temperatures, inputs, costs and weather; and what was measured and expected.
pub(super) fn show(take: &Take) -> Exhibit {
    let mut exhibit = Exhibit::default();
    if !take.scenario.vehicles.is_empty() {
        exhibit.pictures.push(driving::film("Footprints at equal steps of time", take).sketch());
        exhibit.pictures.push(driving::motion("Speeds, gap and accelerations", take).sketch());
        for (index, vehicle) in take.scenario.vehicles.iter().enumerate() {
            let title = format!("What {} ({}) has in mind", vehicle.name, vehicle.driver.kind());
            exhibit.pictures.extend(driving::reasons(&title, take, index).map(|panels| panels.sketch()));
        }
    }
    if take.report.building.is_some() {
        let zones = climate::first_zones(take);
        exhibit.pictures.push(climate::temperatures("Temperatures, day by day", take, &zones).sketch());
        exhibit.pictures.push(climate::inputs("Heat from the equipment, day by day", take, &zones).sketch());
        exhibit.pictures.push(climate::costs("Cost of each day", &[take]).sketch());
        exhibit.pictures.push(climate::weather("Weather", take).sketch());
    }
    exhibit.sheets = measures::side_by_side(&[take]);
    if !take.report.expectations.is_empty() {
        exhibit.sheets.push(measures::expected(&take.report));
    }
    exhibit
}
