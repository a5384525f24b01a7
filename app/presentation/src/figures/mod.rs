//! Every figure and table of the dissertation, reproduced.
//!
//! The registry (`registry.toml`) is data: an [`Entry`] names a figure, describes what the dissertation shows, and
//! states the runs that make it, the drawing, and the error of the dissertation that changes the result. [`make`] makes
//! each run once and draws; a figure that fails does not stop the others.
//!
//! ```text
//! entries -> runs with all their frames -> drawings and tables -> files and page
//! ```

mod climate;
mod driving;
mod entry;
mod lookup;
mod measures;
mod recorded_run;
mod section;
mod space_time;
#[cfg(test)]
mod tests;
mod theory;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;

use crate::plot::{Drawing, PlotError};
pub use entry::{Entry, EntryOutcome, Kind, registry};
pub use lookup::{FigureError, UnknownFigure, find};
pub use recorded_run::{FrameLog, RecordedRun};
use recorded_run::{RunOutcome, RunSpec};
pub use section::{run_page, section};

/// The number of steps of [`make`] for these entries: runs and drawings.
pub fn steps(entries: &[&'static Entry]) -> usize {
    runs(entries).len() + entries.len()
}

/// Makes the entries in parallel and writes their pictures into a folder; `advance` is called after every step.
/// The outcomes are in the order of `entries`.
pub fn make(entries: &[&'static Entry], folder: &Path, advance: &(dyn Fn() + Sync)) -> Vec<EntryOutcome> {
    let run = |spec: &RunSpec| {
        let recorded = spec.record().map_err(Arc::new);
        advance();
        (spec.clone(), recorded)
    };
    let recorded_runs: RecordedRuns = runs(entries).par_iter().with_max_len(1).map(run).collect();
    let draw = |entry: &&'static Entry| {
        let made = make_one(entry, &recorded_runs, folder);
        advance();
        made
    };
    entries.par_iter().with_max_len(1).map(draw).collect()
}

/// The runs of several figures, or their failures.
type RecordedRuns = BTreeMap<RunSpec, Result<RecordedRun, Arc<FigureError>>>;

/// The runs that the entries need, without repetition.
fn runs(entries: &[&'static Entry]) -> Vec<RunSpec> {
    let mut runs: Vec<RunSpec> =
        entries.iter().flat_map(|entry| entry.runs.iter().chain(&entry.beside)).cloned().collect();
    runs.sort();
    runs.dedup();
    runs
}

fn make_one(entry: &'static Entry, recorded_runs: &RecordedRuns, folder: &Path) -> EntryOutcome {
    let of = |runs: &[RunSpec]| -> Vec<Result<&RecordedRun, FigureError>> {
        let find = |spec: &RunSpec| match recorded_runs.get(spec) {
            Some(Ok(recorded)) => Ok(recorded),
            Some(Err(reason)) => {
                Err(FigureError::Shared { scenario: spec.scenario.clone(), reason: Arc::clone(reason) })
            }
            None => Err(FigureError::NotRun(spec.scenario.clone())),
        };
        runs.iter().map(find).collect()
    };
    let (drawn, beside) = (of(&entry.runs), of(&entry.beside));
    let ran: Vec<RunOutcome> = drawn
        .iter()
        .chain(&beside)
        .filter_map(|recorded| recorded.as_ref().ok())
        .map(|recorded| recorded.ran())
        .collect();
    let outcome = drawn.into_iter().collect::<Result<Vec<&RecordedRun>, FigureError>>().and_then(|drawn| {
        let mut content = entry.draw(&drawn)?;
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

/// The outcome of the first drawn run in words, and how each of the others differs from it.
fn outcomes(drawn: &[&RecordedRun], beside: &[&RecordedRun]) -> Vec<(String, String)> {
    let Some((first, others)) = drawn.split_first() else { return Vec::new() };
    let changes = others.iter().chain(beside).filter_map(|other| section::difference(first, other));
    let changes: Vec<String> = changes.collect();
    let mut words = vec![("Reproduced".to_owned(), section::outcome(first))];
    words.extend((!changes.is_empty()).then(|| ("For comparison".to_owned(), changes.join(" "))));
    words
}

/// Writes pictures as `name.svg` and `name.png`; from the second on with a number.
fn save(pictures: &[Drawing], folder: &Path, name: &str) -> Result<(), PlotError> {
    for (index, picture) in pictures.iter().enumerate() {
        let name = if index == 0 { name.to_owned() } else { format!("{name}-{}", index + 1) };
        picture.save(folder, &name)?;
    }
    Ok(())
}
