//! Sections of pages, from made figures and from runs.

use std::path::{Path, PathBuf};

use super::entry::{EntryOutcome, FigureContent};
use super::error::FigureError;
use super::recorded_run::{RecordedRun, RunOutcome};
use super::save;
use super::space_time::space_time;
use super::{climate, driving, measures};
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
