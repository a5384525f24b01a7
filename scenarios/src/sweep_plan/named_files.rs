//! What the files say that a scenario only names: whoever compares scenarios must compare it, too.

use crate::scenario::Scenario;
use crate::weather::WeatherConfig;

/// The settings that name such files, by their first key.
pub(super) const SETTINGS: [&str; 2] = ["weather", "tariff"];

/// The contents of the weather file and of the table of prices of a scenario, where it has them, in words of which no two that differ
/// have the same.
pub(super) fn contents(scenario: &Scenario) -> String {
    let weather = match &scenario.weather {
        Some(WeatherConfig::Epw(file)) => format!("{file:?}"),
        Some(WeatherConfig::Synthetic(_)) | None => String::new(),
    };
    let prices = scenario.tariff.iter().filter(|tariff| tariff.file.is_some());
    let prices: String = prices.map(|tariff| format!("{:?}", tariff.file_prices_per_kwh)).collect();
    weather + &prices
}
