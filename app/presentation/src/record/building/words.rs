//! The text beside the pictures of a building.

use interplay_scenarios::{Scenario, WeatherConfig};

use super::super::markdown::code;

/// What one is looking at, and for what to look.
pub fn about(scenario: &Scenario, command: Option<&str>) -> String {
    let again = command.map(|command| format!(" Again: {}", code(command))).unwrap_or_default();
    let weather = match scenario.weather.clone().unwrap_or_default() {
        WeatherConfig::Synthetic(_) => "a synthetic tropical climate".to_owned(),
        WeatherConfig::Epw(file) => format!("the file {}", code(&file.file)),
    };
    let look = match scenario.controller().kind() {
        "pid" => "the controller has no memory: it is late every morning by as much, and the cost does not fall",
        "thermostat" => "equipment runs at full power or not at all, and temperatures swing about what is wanted",
        "clairvoyant" => "knowing the day beforehand, it cools before people come; no controller can be cheaper",
        "iterative" => {
            "after one day temperatures follow their plan; what is left is what nobody could foresee, answered by a \
             feedback gain that is designed anew as the uncertainty becomes known"
        }
        "concurrent" => {
            "after one day temperatures stay within the comfort band although the forecast is wrong: the feedback is \
             shaped for what is uncertain"
        }
        "distributed" => {
            "zones that speak with their neighbours only come to a common plan round by round, and cool before people come"
        }
        "centralised" => "one problem for the whole building: what zones that plan together approach",
        _ => "day by day the temperatures come closer to what is wanted when people arrive, and the cost falls",
    };
    format!(
        "### {title}\n\n{shows}.{again}\n\n**Look for**: {look}.\n\n\
         A day is an iteration of the controller ({kind}); {days} days in {weather}. Where no wanted temperature is \
         drawn nobody is there, and the temperature is free. The cost J of a day adds squared deviations and squared \
         power; *cheapest possible* is what the same day would have cost had everything been known. The timeline \
         `iteration` counts days.\n",
        title = scenario.title,
        shows = scenario.shows.trim_end_matches('.'),
        kind = scenario.controller().kind(),
        days = scenario.days(),
    )
}
