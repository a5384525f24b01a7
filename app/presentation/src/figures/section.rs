//! Sections of pages, from made figures and from runs.

use std::path::{Path, PathBuf};

use super::entry::{EntryOutcome, FigureContent};
use super::lookup::FigureError;
use super::recorded_run::{RecordedRun, RunOutcome};
use super::space_time::space_time;
use super::{climate, driving, measures, save};
use crate::page::{Page, Section, SectionStatus};
use crate::plot::TextTable;
use crate::report::summary;
use crate::shell;

/// The section of a page that shows a figure.
pub fn section(made: &EntryOutcome) -> Section {
    let entry = made.entry;
    let mut section = Section {
        id: entry.id(),
        heading: format!("{entry}: {}", entry.title),
        verdict: verdict(&made.runs),
        words: vec![("The dissertation".to_owned(), entry.says.clone())],
        ..Section::default()
    };
    if let Some(erratum) = &entry.erratum {
        section.words.push(("Error of the dissertation and its effect".to_owned(), erratum.clone()));
    }
    let commands = made.runs.iter().map(|run| shell::line(run.command.iter().map(String::as_str)));
    let again = format!("interplay reproduce {}", entry.id());
    section.commands = std::iter::once(again).chain(commands).collect();
    match &made.outcome {
        Ok(content) => fill(&mut section, content),
        Err(reason) => section.verdict = SectionStatus::Broken(reason.to_string()),
    }
    section
}

/// Draws a run and writes the pictures and a page that shows them, `index.html`, into a folder. `files` are already there, each
/// with its description. Returns the path of the page.
///
/// # Errors
/// [`FigureError`], if a picture cannot be drawn or the disk refuses a file.
pub fn run_page(recorded: &RecordedRun, folder: &Path, files: Vec<(String, String)>) -> Result<PathBuf, FigureError> {
    let content = run_content(recorded);
    save(&content.pictures, folder, "picture")?;
    let page = Page {
        title: recorded.scenario.title.clone(),
        opening: Vec::new(),
        sections: vec![run_section(recorded, &content, files)],
    };
    let path = folder.join("index.html");
    match interplay_files::write(&path, page.html().as_bytes()) {
        Ok(()) => Ok(path),
        Err(reason) => Err(FigureError::Page { path, reason }),
    }
}

/// The section of a page that shows a run; `files` are in the folder of the page.
fn run_section(recorded: &RecordedRun, content: &FigureContent, files: Vec<(String, String)>) -> Section {
    let is_judged = !recorded.report.expectations.is_empty() || !recorded.report.counterfactuals.is_empty();
    let held = is_judged.then_some(recorded.report.passed);
    let ran = RunOutcome { command: recorded.command.clone(), held };
    let mut section = Section {
        id: "run".to_owned(),
        heading: recorded.report.scenario.clone(),
        verdict: verdict(std::slice::from_ref(&ran)),
        words: vec![("What it shows".to_owned(), recorded.scenario.shows.clone())],
        commands: vec![shell::line(recorded.command.iter().map(String::as_str))],
        files,
        ..Section::default()
    };
    if let Some(figure) = &recorded.scenario.figure {
        section.words.push(("In the dissertation".to_owned(), format!("Fig. {figure}")));
    }
    fill(&mut section, content);
    section.commands.push(format!("\n{}", summary(&recorded.scenario.title, &recorded.report).trim_end()));
    section
}

fn verdict(runs: &[RunOutcome]) -> SectionStatus {
    let judged: Vec<bool> = runs.iter().filter_map(|run| run.held).collect();
    match judged.iter().all(|held| *held) {
        _ if judged.is_empty() => SectionStatus::Shown,
        true => SectionStatus::Held,
        false => SectionStatus::Missed,
    }
}

fn fill(section: &mut Section, content: &FigureContent) {
    for picture in &content.pictures {
        match picture.svg() {
            Ok(svg) => section.pictures.push((picture.words().join("; "), svg)),
            Err(error) => section.verdict = SectionStatus::Broken(error.to_string()),
        }
    }
    section.tables.extend(content.tables.iter().cloned());
    section.words.extend(content.words.iter().cloned());
}

/// Most vehicles whose planner diagnostics are all drawn; of more vehicles, only those of the ego are.
const MAX_EXPLAINED_VEHICLES: usize = 16;

/// Pictures and tables of a run: footprints, speeds, gaps and planner diagnostics of vehicles; temperatures, inputs, costs and
/// weather of a building; measures and expectations.
fn run_content(recorded: &RecordedRun) -> FigureContent {
    let mut content = FigureContent::default();
    if !recorded.scenario.vehicles.is_empty() {
        // A crowd has too many vehicles for individual footprints and speeds.
        if !recorded.scenario.is_crowd() {
            content.pictures.push(driving::footprints("Footprints at equal steps of time", recorded).drawing());
            content.pictures.push(driving::motion("Speeds, gap and accelerations", recorded).drawing());
        }
        content
            .pictures
            .extend(space_time("Positions of all vehicles over time", recorded).map(|panels| panels.drawing()));
        let (ego, vehicles) = (recorded.scenario.ego_index(), &recorded.scenario.vehicles);
        let explained = vehicles.iter().enumerate();
        for (index, vehicle) in explained.filter(|(index, _)| vehicles.len() <= MAX_EXPLAINED_VEHICLES || *index == ego)
        {
            let title =
                format!("What the planner of {} ({}) believes and intends", vehicle.name, vehicle.driver.kind());
            content
                .pictures
                .extend(driving::planner_diagnostics(&title, recorded, index).map(|panels| panels.drawing()));
        }
    }
    if recorded.report.building.is_some() {
        let zones = climate::first_zones(recorded);
        content.pictures.push(climate::temperatures("Temperatures, day by day", recorded, &zones).drawing());
        content.pictures.push(climate::inputs("Heat from the equipment, day by day", recorded, &zones).drawing());
        content.pictures.push(climate::costs("Cost of each day", &[recorded]).drawing());
        content.pictures.push(climate::weather(weather_title(recorded), recorded).drawing());
    }
    // Each measure has a row: a single row with all measures would be wider than a page.
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

/// Stands for the time of a goal that is not reached, or that is reached from the start.
const GOAL_NOT_REACHED: &str = "never";

/// The outcome of a run in words: what the scenario shows, and the compared facts.
pub fn outcome(recorded: &RecordedRun) -> String {
    let mut sentences = vec![recorded.scenario.shows.trim_end_matches('.').to_owned()];
    let known = facts(recorded).into_iter().filter(|(_, value)| value != GOAL_NOT_REACHED);
    sentences.extend(known.map(|(what, value)| format!("{what} {value}")));
    let mut text = sentences.remove(0);
    text.push_str(". ");
    text.push_str(&capitalised(&sentences.join("; ")));
    text.push('.');
    text
}

/// The facts of `beside` that differ from those of `recorded`, in words; `None` if `beside` has no label.
pub fn difference(recorded: &RecordedRun, beside: &RecordedRun) -> Option<String> {
    let changed: Vec<String> = facts(recorded)
        .into_iter()
        .zip(facts(beside))
        .filter(|((_, here), (_, there))| here != there)
        .map(|((what, here), (_, there))| format!("{what} {there} instead of {here}"))
        .collect();
    let result = if changed.is_empty() { "nothing that is measured changes".to_owned() } else { changed.join("; ") };
    (!beside.label.is_empty()).then(|| format!("{}: {result}.", capitalised(&beside.label)))
}

/// The facts of a run that are compared, always in the same order.
fn facts(recorded: &RecordedRun) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let report = &recorded.report;
    if let Some(ego) = report.vehicles.get(recorded.scenario.ego_index()) {
        let goal = ego.completed_s.map_or_else(|| GOAL_NOT_REACHED.to_owned(), |time_s| format!("at {time_s:.1} s"));
        facts.push((format!("{} reaches its goal", ego.name), goal));
        facts.push(("order at the end".to_owned(), report.order.join(", ")));
        let gap = report.min_gap_m().map_or_else(|| "none".to_owned(), |gap_m| format!("{gap_m:.2} m"));
        facts.push(("smallest gap".to_owned(), gap));
        facts.push(("slowest".to_owned(), format!("{:.2} m/s", ego.speed_range_mps()[0])));
        facts.push(("collisions".to_owned(), report.collisions.len().to_string()));
    }
    let days = report.building.as_ref().map(|building| building.iterations.as_slice()).unwrap_or_default();
    if let (Some(first), Some(last)) = (days.first(), days.last()) {
        facts.push(("cost of the first day".to_owned(), format!("{:.0}", first.figures.cost)));
        facts.push(("cost of the last day".to_owned(), format!("{:.1}", last.figures.cost)));
        facts.push(("error on the last day".to_owned(), format!("{:.2} K", last.figures.tracking_rmse_c)));
        let outside: f64 = days[1..].iter().map(|day| day.figures.discomfort_k_h).sum();
        let outside = outside / days[1..].len().max(1) as f64;
        facts.push(("outside the comfort band after the first day".to_owned(), format!("{outside:.2} K·h a day")));
        if let Some(exchange) = &last.exchange {
            facts.push(("rounds of messages on the last day".to_owned(), exchange.rounds.to_string()));
        }
    }
    facts
}

fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::super::RunSpec;
    use super::*;

    #[test]
    fn the_difference_between_two_runs_lists_the_facts_that_differ() {
        let recorded =
            |label: &str, sets: &[&str]| RunSpec::new(label, "lane-change/front-nice", sets).record().expect("a run");
        let (nice, other) =
            (recorded("", &[]), recorded("conservative", &["vehicle.ego.driver.kind=\"conservative\""]));
        let words = outcome(&nice);
        assert!(words.contains(". Ego reaches its goal at "), "{words}");
        let words = difference(&nice, &other).expect("it has a label");
        assert!(words.starts_with("Conservative: ego reaches its goal at "), "{words}");
        assert!(words.contains("order at the end front, ego, rear instead of ego, front, rear"), "{words}");
        assert_eq!(difference(&other, &nice), None, "the other run has no label");
        assert!(difference(&other, &other).expect("a label").contains("nothing that is measured changes"));
    }
}
