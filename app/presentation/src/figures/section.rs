//! From what was made to parts of a page.

use std::path::{Path, PathBuf};

use super::entry::{EntryOutcome, FigureContent};
use super::error::FigureError;
use super::recorded_run::{RecordedRun, RunOutcome};
use super::save::save;
use super::show::show;
use crate::page::{Page, Section, SectionStatus};
use crate::report::summary;
use crate::shell;

/// The part of the page that shows a figure.
pub fn section(made: &EntryOutcome) -> Section {
    let entry = made.entry;
    let mut section = Section {
        id: entry.id(),
        heading: format!("{entry}: {}", entry.title),
        verdict: verdict(&made.runs),
        words: vec![("The source".to_owned(), entry.says.to_owned())],
        ..Section::default()
    };
    if let Some(erratum) = entry.erratum {
        section.words.push(("What the source has wrong, and what that changes".to_owned(), erratum.to_owned()));
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

/// Draws all there is to see of a run and puts it on a page, `index.html` in a folder, beside the pictures as files.
/// `files` are already there, each with what it is. Says where the page is.
///
/// # Errors
/// [`FigureError`], if a picture cannot be drawn or the disk refuses a file.
pub fn run_page(recorded: &RecordedRun, folder: &Path, files: Vec<(String, String)>) -> Result<PathBuf, FigureError> {
    let content = show(recorded);
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

/// The part of the page that shows a run of its own; `files` lie beside the page.
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
        section.words.push(("In the source".to_owned(), format!("Fig. {figure}")));
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
