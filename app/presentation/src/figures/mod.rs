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
mod entry;
mod find;
mod measures;
mod save;
mod section;
mod show;
mod take;
#[cfg(test)]
mod tests;
mod theory;
mod words;

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;

pub use entry::{Draw, Entry, Exhibit, Kind, Made};
pub use find::{UnknownFigure, find};
use save::save;
pub use section::{own_page, section};
pub use take::{Camera, Ran, Shot, Take};

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
