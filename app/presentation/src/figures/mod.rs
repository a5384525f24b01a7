//! Every figure and table of the source, and how each is made again.
//!
//! The registry is data, a file a chapter: an [`Entry`] names a figure, says what the source shows, which runs make it
//! ([`RunSpec`]s of authored scenarios), which drawing, and where an erratum changes the result. [`make`] runs what is needed,
//! each of them once, and draws; a figure that fails does not stop the others.
//!
//! ```text
//! entries -> runs with all their frames -> drawings and tables -> files and page
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
mod error;
mod lookup;
mod measures;
mod recorded_run;
mod save;
mod section;
mod sentences;
mod show;
mod space_time;
#[cfg(test)]
mod tests;
mod theory;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;

pub use entry::{Draw, Entry, EntryOutcome, FigureContent, Kind};
pub use error::FigureError;
pub use lookup::{UnknownFigure, find};
pub use recorded_run::{FrameLog, RecordedRun, RunOutcome, RunSpec};
use save::save;
pub use section::{run_page, section};

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
    runs(entries).len() + entries.len()
}

/// Makes the entries in parallel and writes their pictures into a folder; `advance` is called after every step.
/// They come in the order in which they were asked for.
pub fn make(entries: &[&'static Entry], folder: &Path, advance: &(dyn Fn() + Sync)) -> Vec<EntryOutcome> {
    let run = |spec: &RunSpec| {
        let recorded = spec.record().map_err(Arc::new);
        advance();
        (*spec, recorded)
    };
    let recorded_runs: RecordedRuns = runs(entries).par_iter().with_max_len(1).map(run).collect();
    let draw = |entry: &&'static Entry| {
        let made = make_one(entry, &recorded_runs, folder);
        advance();
        made
    };
    entries.par_iter().with_max_len(1).map(draw).collect()
}

/// The runs of several figures, or why there is none.
type RecordedRuns = BTreeMap<RunSpec, Result<RecordedRun, Arc<FigureError>>>;

/// What has to be run, each once.
fn runs(entries: &[&'static Entry]) -> Vec<RunSpec> {
    let mut runs: Vec<RunSpec> =
        entries.iter().flat_map(|entry| entry.runs.iter().chain(entry.beside)).copied().collect();
    runs.sort();
    runs.dedup();
    runs
}

fn make_one(entry: &'static Entry, recorded_runs: &RecordedRuns, folder: &Path) -> EntryOutcome {
    let of = |runs: &[RunSpec]| -> Vec<Result<&RecordedRun, FigureError>> {
        let taken = |spec: &RunSpec| match recorded_runs.get(spec) {
            Some(Ok(recorded)) => Ok(recorded),
            Some(Err(reason)) => Err(FigureError::Shared { scenario: spec.scenario, reason: Arc::clone(reason) }),
            None => Err(FigureError::NotRun(spec.scenario)),
        };
        runs.iter().map(taken).collect()
    };
    let (drawn, beside) = (of(entry.runs), of(entry.beside));
    let ran: Vec<RunOutcome> = drawn
        .iter()
        .chain(&beside)
        .filter_map(|recorded| recorded.as_ref().ok())
        .map(|recorded| recorded.ran())
        .collect();
    let outcome = drawn.into_iter().collect::<Result<Vec<&RecordedRun>, FigureError>>().and_then(|drawn| {
        let mut content = (entry.draw)(entry, &drawn)?;
        let beside: Vec<&RecordedRun> = beside.into_iter().flatten().collect();
        if entry.kind == Kind::Figure {
            content.words.extend(outcomes(&drawn, &beside));
            let measured: Vec<&RecordedRun> = drawn.into_iter().chain(beside).collect();
            content.tables.extend(measures::side_by_side(&measured));
        }
        save(&content.pictures, folder, &entry.id())?;
        Ok(content)
    });
    EntryOutcome { entry, outcome, runs: ran }
}

/// What came of the run that is drawn, and what each of the others changes.
fn outcomes(drawn: &[&RecordedRun], beside: &[&RecordedRun]) -> Vec<(String, String)> {
    let Some((first, others)) = drawn.split_first() else { return Vec::new() };
    let changes = others.iter().chain(beside).filter_map(|other| sentences::difference(first, other));
    let changes: Vec<String> = changes.collect();
    let mut words = vec![("Here".to_owned(), sentences::outcome(first))];
    words.extend((!changes.is_empty()).then(|| ("Beside it".to_owned(), changes.join(" "))));
    words
}
