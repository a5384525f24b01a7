//! The contents of the files that a scenario names: a comparison of two scenarios must include them.

use interplay_building::energy::Tariff;

use crate::model::building::weather::WeatherSource;
use crate::model::scenario::{Scenario, Vehicle};

/// The settings that name such files, by their first key.
pub(super) const SETTINGS: [&str; 4] = ["weather", "tariff", "gains", "vehicle"];

/// The contents of the weather file, of the tables of prices and gains and of recorded vehicles of a scenario, where it has them, in words of which no two that differ
/// have the same.
pub(super) fn contents(scenario: &Scenario) -> String {
    let weather = match &scenario.weather {
        WeatherSource::Epw(weather) => format!("{:?}{:?}", weather.stated, weather.rows),
        WeatherSource::Csv(weather) => format!("{:?}{:?}", weather.stated, weather.weather),
        WeatherSource::Synthetic(_) => String::new(),
    };
    // The interval of hourly prices is left out, so that plans keep the keys of their runs.
    let by_the_hour = |tariff: &Tariff| tariff.interval_s == 3600.0;
    let interval = |tariff: &Tariff| if by_the_hour(tariff) { String::new() } else { tariff.interval_s.to_string() };
    let told = |tariff: &Tariff| format!("{:?}{}", tariff.prices_per_kwh, interval(tariff));
    let prices: String = scenario.tariff.iter().map(told).collect();
    let gains: String = scenario.gains.iter().map(|gains| format!("{:?}", gains.zones)).collect();
    let is_recorded = |vehicle: &&Vehicle| vehicle.driver.record().is_some();
    let records: String =
        scenario.vehicles.iter().filter(is_recorded).map(|vehicle| format!("{:?}", vehicle.driver)).collect();
    weather + &prices + &gains + &records
}
