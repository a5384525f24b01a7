//! Every figure and table of the source, and how each is made again.
//!
//! The registry is data, a file a chapter: an [`Entry`] names a figure, says what the source shows, which runs make it
//! ([`Shot`]s of authored scenarios), which drawing, and where an erratum changes the result. [`make`] runs what is needed,
//! each shot once, and draws; a figure that fails does not stop the others.
//!
//! ```text
//! entries -> shots -> takes (runs with all their frames) -> sketches and sheets -> files and page
//! ```

mod chapter2;
mod chapter3;
mod chapter4;
mod chapter5;
mod chapter6;
mod chapter7;
mod chapter8;
mod climate;
mod drawings;
mod driving;
mod find;
mod measures;
mod section;
mod show;
mod take;
#[cfg(test)]
mod tests;
mod theory;
mod words;

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use rayon::prelude::*;

use crate::plot::{Sheet, Sketch};

pub use find::{UnknownFigure, find};
pub use section::{own_page, section};
use show::show;
pub use take::{Camera, Shot, Take};

/// What an entry is in the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A figure.
    Figure,
    /// A table.
    Table,
}

/// A figure or table of the source.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Whether it is a figure or a table.
    pub kind: Kind,
    /// Its number, such as `6.1`.
    pub number: &'static str,
    /// What it shows, in a line.
    pub title: &'static str,
    /// What the source says of it.
    pub says: &'static str,
    /// What the source has wrong that concerns it, and what that does.
    pub erratum: Option<&'static str>,
    /// The runs that are drawn.
    pub shots: &'static [Shot],
    /// Runs that are measured beside them, such as another planner or the equations as printed.
    pub beside: &'static [Shot],
    /// How it is drawn from the takes of `shots`.
    pub draw: Draw,
}

/// How an entry is drawn from its takes.
pub type Draw = fn(&Entry, &[&Take]) -> Result<Exhibit, String>;

/// What came of an entry, or of a run: pictures, and tables of what was measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exhibit {
    /// The pictures.
    pub pictures: Vec<Sketch>,
    /// What was measured.
    pub sheets: Vec<Sheet>,
    /// What came of it, in sentences with a word in front of each.
    pub words: Vec<(String, String)>,
}

impl From<Sketch> for Exhibit {
    fn from(picture: Sketch) -> Exhibit {
        Exhibit { pictures: vec![picture], ..Exhibit::default() }
    }
}

impl Entry {
    /// The name of its files, and what the command line calls it: `fig-6.1`, `table-6.1`.
    pub fn id(&self) -> String {
        let kind = match self.kind {
            Kind::Figure => "fig",
            Kind::Table => "table",
        };
        format!("{kind}-{}", self.number)
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            Kind::Figure => "Fig.",
            Kind::Table => "Table",
        };
        write!(f, "{kind} {}", self.number)
    }
}

/// Every figure and table, by chapters, figures before tables.
pub fn registry() -> impl Iterator<Item = &'static Entry> {
    let chapters = [
        chapter2::ENTRIES,
        chapter3::ENTRIES,
        chapter4::ENTRIES,
        chapter5::ENTRIES,
        chapter6::ENTRIES,
        chapter7::ENTRIES,
        chapter8::ENTRIES,
    ];
    chapters.into_iter().flatten()
}

/// What became of an entry.
#[derive(Clone, Debug)]
pub struct Made {
    /// The entry.
    pub entry: &'static Entry,
    /// What was drawn and measured, or why not.
    pub outcome: Result<Exhibit, String>,
    /// How each run went that was asked of it and could be finished.
    pub runs: Vec<Ran>,
}

/// How a run went.
#[derive(Clone, Debug, PartialEq)]
pub struct Ran {
    /// The words of the command that runs the same.
    pub command: Vec<String>,
    /// Whether its expectations held; `None` if the scenario was changed or expects nothing.
    pub held: Option<bool>,
}

impl Made {
    /// Whether every run did what its scenario expects.
    pub fn held(&self) -> bool {
        self.runs.iter().all(|run| run.held != Some(false))
    }
}

/// How many steps [`make`] takes for these entries: runs, and drawings.
pub fn steps(entries: &[&'static Entry]) -> usize {
    shots(entries).len() + entries.len()
}

/// Makes the entries in parallel and writes their pictures into a folder; `advance` is told of every step that is done.
/// They come in the order in which they were asked for.
pub fn make(entries: &[&'static Entry], folder: &Path, advance: &(dyn Fn() + Sync)) -> Vec<Made> {
    let run = |shot: &Shot| {
        let take = shot.take();
        advance();
        (*shot, take)
    };
    let takes: BTreeMap<Shot, Result<Take, String>> = shots(entries).par_iter().with_max_len(1).map(run).collect();
    let draw = |entry: &&'static Entry| {
        let made = make_one(entry, &takes, folder);
        advance();
        made
    };
    entries.par_iter().with_max_len(1).map(draw).collect()
}

/// What has to be run, each once.
fn shots(entries: &[&'static Entry]) -> Vec<Shot> {
    let mut shots: Vec<Shot> =
        entries.iter().flat_map(|entry| entry.shots.iter().chain(entry.beside)).copied().collect();
    shots.sort();
    shots.dedup();
    shots
}

fn make_one(entry: &'static Entry, takes: &BTreeMap<Shot, Result<Take, String>>, folder: &Path) -> Made {
    let of = |shots: &[Shot]| -> Vec<Result<&Take, String>> {
        let taken = |shot: &Shot| match takes.get(shot) {
            Some(Ok(take)) => Ok(take),
            Some(Err(error)) => Err(format!("{}: {error}", shot.scenario)),
            None => Err(format!("{} was not run", shot.scenario)),
        };
        shots.iter().map(taken).collect()
    };
    let (drawn, beside) = (of(entry.shots), of(entry.beside));
    let ran: Vec<Ran> =
        drawn.iter().chain(&beside).filter_map(|take| take.as_ref().ok()).map(|take| take.ran()).collect();
    let outcome = drawn.into_iter().collect::<Result<Vec<&Take>, String>>().and_then(|drawn| {
        let mut exhibit = (entry.draw)(entry, &drawn)?;
        let beside: Vec<&Take> = beside.into_iter().flatten().collect();
        if entry.kind == Kind::Figure {
            exhibit.words.extend(told(&drawn, &beside));
            let measured: Vec<&Take> = drawn.into_iter().chain(beside).collect();
            exhibit.sheets.extend(measures::side_by_side(&measured));
        }
        save(&exhibit.pictures, folder, &entry.id())?;
        Ok(exhibit)
    });
    Made { entry, outcome, runs: ran }
}

/// What came of the run that is drawn, and what each of the others changes.
fn told(drawn: &[&Take], beside: &[&Take]) -> Vec<(String, String)> {
    let Some((first, others)) = drawn.split_first() else { return Vec::new() };
    let changes = others.iter().chain(beside).filter_map(|other| words::difference(first, other));
    let changes: Vec<String> = changes.collect();
    let mut told = vec![("Here".to_owned(), words::outcome(first))];
    told.extend((!changes.is_empty()).then(|| ("Beside it".to_owned(), changes.join(" "))));
    told
}

/// Writes pictures as `name.svg` and `name.png`; from the second on with a number.
///
/// # Errors
/// In words, if one cannot be drawn or written.
fn save(pictures: &[Sketch], folder: &Path, name: &str) -> Result<(), String> {
    for (index, picture) in pictures.iter().enumerate() {
        let name = if index == 0 { name.to_owned() } else { format!("{name}-{}", index + 1) };
        picture.save(folder, &name).map_err(|error| error.to_string())?;
    }
    Ok(())
}
