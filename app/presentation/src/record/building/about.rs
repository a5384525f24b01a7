//! The text beside the pictures of a building.

use interplay_common::spelling::counted;
use interplay_scenarios::{Scenario, WeatherSource};

use super::super::markdown::code;

/// The text of a recording of a building: what it shows and what to look for.
pub fn about(scenario: &Scenario, command: Option<&str>) -> String {
    let again = command.map(|command| format!(" Again: {}", code(command))).unwrap_or_default();
    let weather = match &scenario.weather {
        WeatherSource::Synthetic(synthetic) => format!("synthetic weather around {} °C", synthetic.climate.mean_c),
        WeatherSource::Epw(weather) => format!("the file {}", code(&weather.stated.file)),
        WeatherSource::Csv(weather) => format!("the table {}", code(&weather.stated.file)),
    };
    format!(
        "**{title}**\n\n{shows}.{again}\n\n**Look for**: {look}.\n\n\
         A day is an iteration of the controller ({kind}); {days} in {weather}. Where no wanted temperature is \
         drawn nobody is there, and the temperature is free. The cost J of a day adds squared deviations and squared \
         power; *cheapest possible* is what the same day would have cost had everything been known. The timeline \
         `iteration` counts days.\n",
        title = scenario.title,
        look = scenario.controller().look_for(),
        shows = scenario.shows.trim_end_matches('.'),
        kind = scenario.controller().kind(),
        days = counted(scenario.days(), "day"),
    )
}
