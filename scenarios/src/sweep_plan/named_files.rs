//! What the files say that a scenario only names: whoever compares scenarios must compare it, too.

use crate::file_format::weather::WeatherSource;
use crate::scenario::{Scenario, Vehicle};

/// The settings that name such files, by their first key.
pub(super) const SETTINGS: [&str; 3] = ["weather", "tariff", "vehicle"];

/// The contents of the weather file, of the table of prices and of recorded vehicles of a scenario, where it has them, in words of which no two that differ
/// have the same.
pub(super) fn contents(scenario: &Scenario) -> String {
    let weather = match &scenario.weather {
        WeatherSource::Epw(weather) => format!("{:?}{:?}", weather.stated, weather.rows),
        WeatherSource::Synthetic(_) => String::new(),
    };
    let prices: String = scenario.tariff.iter().map(|tariff| format!("{:?}", tariff.prices_per_kwh)).collect();
    let is_recorded = |vehicle: &&Vehicle| vehicle.driver.record().is_some();
    let records: String =
        scenario.vehicles.iter().filter(is_recorded).map(|vehicle| format!("{:?}", vehicle.driver)).collect();
    weather + &prices + &records
}
