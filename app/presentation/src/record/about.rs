//! The text that says what one is looking at.

use super::re_sdk_types::archetypes::TextDocument;
use super::re_sdk_types::components::MediaType;
use interplay_common::spelling::counted;
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::report::CounterfactualReport;
use rerun::{RecordingStream, RecordingStreamResult};

use super::building;
use super::markdown::code;
use super::palette::{FAILURE, NamedColour};
use super::planner_panels;

/// Logs the text beside the pictures.
///
/// # Errors
/// If Rerun refuses a component.
pub fn about(
    stream: &RecordingStream,
    scenario: &Scenario,
    vehicle_colours: &[NamedColour],
    command: Option<&str>,
    counterfactuals: &[CounterfactualReport],
) -> RecordingStreamResult<()> {
    let driving = (!scenario.vehicles.is_empty()).then(|| description(scenario, vehicle_colours, command));
    let command = command.filter(|_| driving.is_none());
    let building = scenario.building.is_some().then(|| building::about(scenario, command));
    let verdicts = (!counterfactuals.is_empty()).then(|| verdicts(counterfactuals));
    let clocks = (driving.is_some() && building.is_some()).then(|| clocks(scenario));
    let driving = driving.into_iter().chain(clocks);
    let text = driving.chain(building).chain(verdicts).collect::<Vec<_>>().join("\n\n");
    stream.log_static("about", &TextDocument::new(text).with_media_type(MediaType::MARKDOWN))
}

fn description(scenario: &Scenario, vehicle_colours: &[NamedColour], command: Option<&str>) -> String {
    let again = command.map(|command| format!(" Again: {}", code(command))).unwrap_or_default();
    let figure = scenario.figure.as_ref().map(|figure| format!(" (figure {figure})")).unwrap_or_default();
    let who: String = scenario
        .vehicles
        .iter()
        .zip(vehicle_colours)
        .map(|(vehicle, vehicle_colour)| row(vehicle, *vehicle_colour))
        .collect();
    format!(
        "**{title}**\n\n{shows}{figure}.{again}\n\n\
         **On the road**, in each vehicle's colour: a *thick line* ahead is its plan, *dashes* are what the others expect of it, a \
         *pale line* is where it was, *dots* are what it asks another vehicle to do. The ego's centre keeps out of the *white \
         ellipses*. A plan in *{failure}* is a fallback, because the planner has none; the events say why. Red lights: it brakes. \
         Yellow lights: it is going to turn or to change lanes.\n\n\
         | vehicle | colour | driver |\n|---|---|---|\n{who}{guide}",
        guide = planner_panels::guide(scenario),
        title = scenario.title,
        shows = scenario.shows.trim_end_matches('.'),
        failure = FAILURE.word,
    )
}

/// How vehicles and building share the time.
fn clocks(scenario: &Scenario) -> String {
    format!(
        "**Two clocks**: the vehicles drive during the first {:.0} s of {}. *The building* has its own tab; for its days \
         drag the time cursor, or play some thousand times faster.",
        scenario.duration_s,
        counted(scenario.days(), "day")
    )
}

/// What became of the counterfactuals, a line each.
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
    format!("**Counterfactuals**, runs beside this one in which something is changed:\n\n{lines}")
}

fn row(vehicle: &Vehicle, vehicle_colour: NamedColour) -> String {
    format!("| **{}** | {} | {} |\n", vehicle.name, vehicle_colour.word, vehicle.driver.description())
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;
    use interplay_simulation::run::run_with_counterfactuals;

    use super::super::palette::vehicle_colours;
    use super::{description, verdicts};

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
            text.contains("second: **failed** (order crossing, ego) `order_differs: want true, got true`\n"),
            "{text}"
        );
    }

    #[test]
    fn the_text_says_how_to_repeat_the_run() {
        let scenario = load("lane-change/front-nice", &[]).expect("embedded");
        let text = |command| description(&scenario, &vehicle_colours(&scenario), command);
        assert!(text(Some("interplay run a --seed 2")).contains("(figure 6.1). Again: `interplay run a --seed 2`\n"));
        assert!(!text(None).contains("Again"));
    }
}
