//! What the files say that a scenario only names: whoever compares scenarios must compare it, too.

use crate::file_format::weather::WeatherSource;
use crate::scenario::Scenario;

/// The settings that name such files, by their first key.
pub(super) const SETTINGS: [&str; 2] = ["weather", "tariff"];

/// The contents of the weather file and of the table of prices of a scenario, where it has them, in words of which no two that differ
/// have the same.
pub(super) fn contents(scenario: &Scenario) -> String {
    let weather = match &scenario.weather {
        WeatherSource::Epw(weather) => format!("{:?}{:?}", weather.stated, weather.rows),
        WeatherSource::Synthetic(_) => String::new(),
    };
    let prices: String = scenario.tariff.iter().map(|tariff| format!("{:?}", tariff.prices_per_kwh)).collect();
    weather + &prices
}
