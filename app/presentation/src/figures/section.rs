//! From what was made to parts of a page.

use std::path::{Path, PathBuf};

use super::entry::{Exhibit, Made};
use super::save::save;
use super::show::show;
use super::take::{Ran, Take};
use crate::page::{Page, Section, Verdict};
use crate::report::summary;
use crate::shell;

/// The part of the page that shows a figure.
pub fn section(made: &Made) -> Section {
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
        Ok(exhibit) => fill(&mut section, exhibit),
        Err(reason) => section.verdict = Verdict::Broken(reason.clone()),
    }
    section
}

/// Draws all there is to see of a run and puts it on a page, `index.html` in a folder, beside the pictures as files.
/// `files` are already there, each with what it is. Says where the page is.
///
/// # Errors
/// In words, if a picture cannot be drawn or the disk refuses a file.
pub fn own_page(take: &Take, folder: &Path, files: Vec<(String, String)>) -> Result<PathBuf, String> {
    let exhibit = show(take);
    save(&exhibit.pictures, folder, "picture")?;
    let page = Page {
        title: take.scenario.title.clone(),
        opening: Vec::new(),
        sections: vec![own_section(take, &exhibit, files)],
    };
    let path = folder.join("index.html");
    let written = std::fs::write(&path, page.html());
    written.map_err(|error| format!("cannot write {}: {error}; name another folder with --report", path.display()))?;
    Ok(path)
}

/// The part of the page that shows a run of its own; `files` lie beside the page.
fn own_section(take: &Take, exhibit: &Exhibit, files: Vec<(String, String)>) -> Section {
    let held = (!take.report.expectations.is_empty()).then_some(take.report.passed);
    let ran = Ran { command: take.command.clone(), held };
    let mut section = Section {
        id: "run".to_owned(),
        heading: take.report.scenario.clone(),
        verdict: verdict(std::slice::from_ref(&ran)),
        words: vec![("What it shows".to_owned(), take.scenario.shows.clone())],
        commands: vec![shell::line(take.command.iter().map(String::as_str))],
        files,
        ..Section::default()
    };
    if let Some(figure) = &take.scenario.figure {
        section.words.push(("In the source".to_owned(), format!("Fig. {figure}")));
    }
    fill(&mut section, exhibit);
    section.commands.push(format!("\n{}", summary(&take.scenario.title, &take.report).trim_end()));
    section
}

fn verdict(runs: &[Ran]) -> Verdict {
    let judged: Vec<bool> = runs.iter().filter_map(|run| run.held).collect();
    match judged.iter().all(|held| *held) {
        _ if judged.is_empty() => Verdict::Shown,
        true => Verdict::Held,
        false => Verdict::Missed,
    }
}

fn fill(section: &mut Section, exhibit: &Exhibit) {
    for picture in &exhibit.pictures {
        match picture.svg() {
            Ok(svg) => section.pictures.push((picture.words().join("; "), svg)),
            Err(error) => section.verdict = Verdict::Broken(error.to_string()),
        }
    }
    section.tables.extend(exhibit.sheets.iter().cloned());
    section.words.extend(exhibit.words.iter().cloned());
}
