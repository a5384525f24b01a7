//! The text of a recording: its content, and the points to look for.

use interplay_common::spelling::counted;
use interplay_scenarios::{Scenario, Vehicle, WeatherSource};
use interplay_simulation::report::CounterfactualReport;
use rerun::RecordingStream;

use super::Logged;
use super::palette::{FAILURE, NamedColour};
use super::planner_panels;
use super::re_sdk_types::archetypes::TextDocument;
use super::re_sdk_types::components::MediaType;

/// Logs the text of the recording.
pub fn about(
    stream: &RecordingStream,
    scenario: &Scenario,
    vehicle_colours: &[NamedColour],
    command: Option<&str>,
    counterfactuals: &[CounterfactualReport],
) -> Logged {
    let driving = (!scenario.vehicles.is_empty()).then(|| driving_description(scenario, vehicle_colours, command));
    let command = command.filter(|_| driving.is_none());
    let building = scenario.building.is_some().then(|| building_description(scenario, command));
    let verdicts = (!counterfactuals.is_empty()).then(|| verdicts(counterfactuals));
    let clocks = (driving.is_some() && building.is_some()).then(|| clocks(scenario));
    let driving = driving.into_iter().chain(clocks);
    let text = driving.chain(building).chain(verdicts).collect::<Vec<_>>().join("\n\n");
    stream.log_static("about", &TextDocument::new(text).with_media_type(MediaType::MARKDOWN))
}

fn driving_description(scenario: &Scenario, vehicle_colours: &[NamedColour], command: Option<&str>) -> String {
    let command = command.map(|command| format!(" Command: {}", code(command))).unwrap_or_default();
    let figure = scenario.figure.as_ref().map(|figure| format!(" (figure {figure})")).unwrap_or_default();
    let vehicles: String = scenario
        .vehicles
        .iter()
        .zip(vehicle_colours)
        .map(|(vehicle, vehicle_colour)| row(vehicle, *vehicle_colour))
        .collect();
    format!(
        "**{title}**\n\n{shows}{figure}.{command}\n\n\
         **On the road**, in each vehicle's colour: a *thick line* ahead is its plan, *dashes* are its motion as the others predict it, a \
         *pale line* is its past path, *dots* are the motion that it requests of another vehicle. The ego's centre keeps out of the \
         *white ellipses*. A plan in *{failure}* is a fallback after the planner failed; the events give the reason. Red lights: the \
         vehicle brakes. Yellow lights: it will turn or change lanes.\n\n\
         | vehicle | colour | driver |\n|---|---|---|\n{vehicles}{guide}",
        guide = planner_panels::guide(scenario),
        title = scenario.title,
        shows = scenario.shows.trim_end_matches('.'),
        failure = FAILURE.word,
    )
}

/// Explains the times of the vehicles and of the building.
fn clocks(scenario: &Scenario) -> String {
    format!(
        "**Two clocks**: the vehicles drive during the first {:.0} s of {}. *The building* has its own tab; for its days \
         drag the time cursor, or play some thousand times faster.",
        scenario.duration_s,
        counted(scenario.days(), "day")
    )
}

/// The outcome of each counterfactual in a line.
fn verdicts(counterfactuals: &[CounterfactualReport]) -> String {
    let lines: String = counterfactuals
        .iter()
        .map(|one| {
            let verdict = if one.passed { "held" } else { "**failed**" };
            let order = if one.order.is_empty() { String::new() } else { format!(" (order {})", one.order.join(", ")) };
            let failed: Vec<String> = one.failed().map(|expectation| code(&expectation.to_string())).collect();
            let failed = if failed.is_empty() { String::new() } else { format!(" {}", failed.join("; ")) };
            format!("- {}: {verdict}{order}{failed}\n", one.name)
        })
        .collect();
    format!("**Counterfactuals**, runs with a change of the scenario:\n\n{lines}")
}

fn row(vehicle: &Vehicle, vehicle_colour: NamedColour) -> String {
    format!("| **{}** | {} | {} |\n", vehicle.name, vehicle_colour.word, vehicle.driver.description())
}

/// The text about a building.
fn building_description(scenario: &Scenario, command: Option<&str>) -> String {
    let command = command.map(|command| format!(" Command: {}", code(command))).unwrap_or_default();
    let weather = match &scenario.weather {
        WeatherSource::Synthetic(synthetic) => format!("synthetic weather around {} °C", synthetic.climate.mean_c),
        WeatherSource::Epw(weather) => format!("the file {}", code(&weather.stated.file)),
        WeatherSource::Csv(weather) => format!("the table {}", code(&weather.stated.file)),
    };
    format!(
        "**{title}**\n\n{shows}.{command}\n\n**Look for**: {look}.\n\n\
         A day is an iteration of the controller ({kind}); {days} in {weather}. Where no wanted temperature is \
         drawn the zone is unoccupied, and its temperature is free. The cost J of a day adds squared deviations and squared \
         power; *cheapest possible* is the least cost of the same day with perfect foresight. The timeline \
         `iteration` counts days.\n",
        title = scenario.title,
        look = scenario.controller().look_for(),
        shows = scenario.shows.trim_end_matches('.'),
        kind = scenario.controller().kind(),
        days = counted(scenario.days(), "day"),
    )
}

/// A text as Markdown code, between more backticks than it has in a row.
fn code(text: &str) -> String {
    let most = text.split(|character| character != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(most + 1);
    if most == 0 { format!("{fence}{text}{fence}") } else { format!("{fence} {text} {fence}") }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;
    use interplay_simulation::run::run_with_counterfactuals;

    use super::super::palette::vehicle_colours;
    use super::*;

    #[test]
    fn every_counterfactual_has_a_line() {
        let scenario = load("intersection/nice", &[]).expect("embedded");
        let mut report = run_with_counterfactuals("nice", &scenario, Vec::new()).expect("a run");
        let text = verdicts(&report.counterfactuals);
        assert!(text.contains("\n- A conservative ego crosses second: held (order crossing, ego)\n"), "{text}");
        let one = &mut report.counterfactuals[0];
        (one.passed, one.expectations[0].passed) = (false, false);
        let text = verdicts(&report.counterfactuals);
        assert!(
            text.contains(
                "second: **failed** (order crossing, ego) `order_differs: wanted: another order; got: another order`\n"
            ),
            "{text}"
        );
    }

    #[test]
    fn the_text_of_a_recording_contains_the_command_of_the_run() {
        let scenario = load("lane-change/front-nice", &[]).expect("embedded");
        let text = |command| driving_description(&scenario, &vehicle_colours(&scenario), command);
        assert!(text(Some("interplay run a --seed 2")).contains("(figure 6.1). Command: `interplay run a --seed 2`\n"));
        assert!(!text(None).contains("Command"));
    }

    #[test]
    fn backticks_in_a_command_do_not_end_its_code_span() {
        assert_eq!(code("interplay run a"), "`interplay run a`");
        assert_eq!(code("--set 'title=`a` ``b``'"), "``` --set 'title=`a` ``b``' ```");
    }
}
