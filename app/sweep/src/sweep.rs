//! Runs a plan, or a shard of it.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use interplay_scenarios::{RunRefusals, Scenario, SweepPlan};
use interplay_tables::{ColumnKind, TableFile, TableSchema};
use rayon::prelude::*;

use crate::column::{schema, write_rows};
use crate::error::SweepError;
use crate::journal::{Journal, JournalIndex, path_of};
use crate::key::RunKey;
use crate::measure::measured_run;
use crate::people_rows::{COLUMNS, rows};
use crate::row::SweepRow;
use crate::shard::Shard;

/// The file with the rows of a whole plan.
pub const RUNS_FILE: &str = "runs.parquet";
/// The file with the plan of a folder's rows.
pub(crate) const PLAN_FILE: &str = "plan.toml";
/// Metadata key of a table: the plan's digest, and the shard.
pub(crate) const PLAN_NOTE: &str = "interplay.plan";
pub(crate) const SHARD_NOTE: &str = "interplay.shard";

/// Keeps a recording of a failed run. Called from several threads.
pub type KeepRecording<'a> = &'a (dyn Fn(&SweepRow, &Scenario) -> Result<(), String> + Sync);

/// How a plan is executed.
pub struct SweepOptions<'a> {
    /// The folder of journals and results; it is created if it does not exist.
    pub folder: &'a Path,
    /// The part of the plan.
    pub shard: Shard,
    /// Called for each run that failed.
    pub keep: Option<KeepRecording<'a>>,
    /// Whether each run also writes its trajectories, as `trajectories/KEY.parquet` in the folder.
    pub trajectories: bool,
    /// Called after each run that is checked, from several threads.
    pub checked: &'a (dyn Fn() + Sync),
    /// Called after the checks, with the number of runs to make and of existing runs.
    pub begin: &'a (dyn Fn(u64, u64) + Sync),
    /// Called after each run, from several threads.
    pub advance: &'a (dyn Fn() + Sync),
}

/// The outcome of a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SweepOutcome {
    /// Path of the table.
    pub table: PathBuf,
    /// Number of rows.
    pub rows: usize,
    /// Number of runs that were made now; the others existed already.
    pub made: u64,
    /// Number of rows without a result.
    pub unfinished: usize,
    /// Damaged lines of journals, whose runs were made again: journal and line, from 1.
    pub damaged: Vec<(PathBuf, usize)>,
}

pub(crate) fn table_path(folder: &Path, shard: Shard) -> PathBuf {
    folder.join(match shard {
        Shard::WHOLE => RUNS_FILE.to_owned(),
        Shard { index, count } => format!("shard-{index}-of-{count}.parquet"),
    })
}

/// The digest of a plan, which all its shards share.
pub(crate) fn plan_digest(plan: &SweepPlan) -> String {
    RunKey::of_parts(&[plan.text()]).to_string()
}

/// Runs a plan, or a shard of it, in the threads of the current pool: checks every run, makes the runs that no journal of the
/// folder contains, and writes the table.
///
/// Runs are not held in memory: each takes 24 bytes for its key and number, and about 60 for the location of its row.
///
/// # Errors
/// If runs are refused, before any is made, or if files cannot be read or written.
pub fn sweep(plan: &SweepPlan, options: &SweepOptions<'_>) -> Result<SweepOutcome, SweepError> {
    sweep_unless(&|| false, plan, options)
}

/// As [`sweep`], until `is_cancelled`, which is asked before each run. The runs in progress are completed and kept.
///
/// # Errors
/// As [`sweep`]; [`SweepError::Cancelled`].
pub fn sweep_unless(
    is_cancelled: &(dyn Fn() -> bool + Sync),
    plan: &SweepPlan,
    options: &SweepOptions<'_>,
) -> Result<SweepOutcome, SweepError> {
    let (folder, shard) = (options.folder, options.shard);
    refuse_file_in_the_way(folder)?;
    refuse_two_of_a_name(plan)?;
    let known = if folder.exists() { JournalIndex::read(folder)? } else { JournalIndex::empty() };
    let part = Part::of(plan, shard, &known, options.checked)?;
    let damaged = known.damaged().to_vec();
    drop(known);
    make_folder(folder, plan)?;
    let journal = Mutex::new(Journal::open(&path_of(folder, shard))?);
    (options.begin)(part.to_make.len() as u64, part.there);
    part.to_make.par_iter().with_max_len(1).try_for_each(|(key, index)| {
        if is_cancelled() {
            return Err(SweepError::Cancelled);
        }
        let point = plan.point(*index);
        let scenario = plan.scenario(&point).map_err(|error| SweepError::Refused(Box::new(error)))?;
        let trajectories = options.trajectories.then(|| TableFile::of_run(folder, key));
        let row = measured_run(*key, &point, &scenario, trajectories.as_ref())?;
        if let Some(keep) = options.keep.filter(|_| row.is_failure()) {
            keep(&row, &scenario).map_err(SweepError::Recording)?;
        }
        journal.lock().unwrap_or_else(PoisonError::into_inner).append(&row)?;
        (options.advance)();
        Ok::<(), SweepError>(())
    })?;
    let journal = journal.into_inner().unwrap_or_else(PoisonError::into_inner);
    journal.sync()?;
    let (rows, unfinished) = write_table(plan, shard, folder, &JournalIndex::read(folder)?, &part.runs)?;
    Ok(SweepOutcome { table: table_path(folder, shard), rows, made: part.to_make.len() as u64, unfinished, damaged })
}

/// Checks all runs of a shard as [`sweep`] does before it makes the first, as if no rows existed; `checked` is called after
/// each, from several threads.
///
/// # Errors
/// If runs are refused or the folder cannot be created.
pub fn check(plan: &SweepPlan, shard: Shard, folder: &Path, checked: &(dyn Fn() + Sync)) -> Result<(), SweepError> {
    refuse_file_in_the_way(folder)?;
    refuse_two_of_a_name(plan)?;
    Part::of(plan, shard, &JournalIndex::empty(), checked).map(|_| ())
}

/// Refuses a folder whose path, or a parent of it, is a file.
fn refuse_file_in_the_way(folder: &Path) -> Result<(), SweepError> {
    match folder.ancestors().find(|above| above.exists()) {
        Some(above) if !above.is_dir() => Err(SweepError::FileInTheWay(above.to_owned())),
        Some(_) | None => Ok(()),
    }
}

/// Refuses a metric of another crate that has the name of a column.
fn refuse_two_of_a_name(plan: &SweepPlan) -> Result<(), SweepError> {
    let columns = schema(&inputs(plan), plan.metrics());
    let mut names = HashSet::new();
    match columns.iter().find(|(name, _)| !names.insert(name)) {
        Some((name, _)) => Err(SweepError::Input(format!("a metric cannot be called `{name}`: a column of rows is"))),
        None => Ok(()),
    }
}

fn inputs(plan: &SweepPlan) -> TableSchema {
    let kind = |is_number: bool| if is_number { ColumnKind::Number } else { ColumnKind::Text };
    plan.inputs().into_iter().map(|(path, is_number)| (path, kind(is_number))).collect()
}

struct Part {
    /// The keys and numbers of all its runs, sorted.
    runs: Vec<(RunKey, u64)>,
    to_make: Vec<(RunKey, u64)>,
    /// Number of runs with a row.
    there: u64,
}

impl Part {
    /// Finds the runs of a shard, and checks those without a row.
    fn of(
        plan: &SweepPlan,
        shard: Shard,
        known: &JournalIndex,
        checked: &(dyn Fn() + Sync),
    ) -> Result<Part, SweepError> {
        let refusals = Mutex::new(RunRefusals::default());
        let check = |index: u64| -> Option<(RunKey, u64)> {
            let point = plan.point(index);
            let key = RunKey::of(plan, &point);
            if !shard.holds(key) {
                return None;
            }
            if !known.holds(key)
                && let Err(refusal) = plan.check(&point)
            {
                let mut all = refusals.lock().unwrap_or_else(PoisonError::into_inner);
                *all = std::mem::take(&mut *all).and(refusal);
            }
            Some((key, index))
        };
        let checked: Vec<(RunKey, u64)> = (0..plan.run_count())
            .into_par_iter()
            .filter_map(|index| {
                let found = check(index);
                checked();
                found
            })
            .collect();
        let refusals = refusals.into_inner().unwrap_or_else(PoisonError::into_inner);
        if !refusals.is_empty() {
            return Err(SweepError::Refused(Box::new(plan.refusal(&refusals))));
        }
        // Runs with one key are one run: variants of the plan with the same changes, or a list that states a value twice.
        let mut seen = HashSet::new();
        let first = checked.iter().filter(|(key, _)| seen.insert(*key));
        let to_make: Vec<(RunKey, u64)> = first.filter(|(key, _)| !known.holds(*key)).copied().collect();
        let there = (seen.len() - to_make.len()) as u64;
        let mut runs = checked;
        runs.sort_unstable();
        // A value that is listed twice gives one row.
        let mut arms: (Option<RunKey>, Vec<[String; 3]>) = (None, Vec::new());
        runs.dedup_by(|next, before| {
            if next.0 != before.0 {
                return false;
            }
            if arms.0 != Some(before.0) {
                arms = (Some(before.0), vec![arm_of(plan, before.1)]);
            }
            let arm = arm_of(plan, next.1);
            let is_known = arms.1.contains(&arm);
            arms.1.push(arm);
            is_known
        });
        Ok(Part { runs, to_make, there })
    }
}

/// The scenario and the drivers of a run, by their names in the plan.
fn arm_of(plan: &SweepPlan, number: u64) -> [String; 3] {
    let point = plan.point(number);
    [point.scenario, point.style, point.planner]
}

/// Creates the folder and writes the plan into it.
fn make_folder(folder: &Path, plan: &SweepPlan) -> Result<(), SweepError> {
    fs::create_dir_all(folder).map_err(SweepError::file("make the folder", folder))?;
    let path = folder.join(PLAN_FILE);
    match fs::read_to_string(&path) {
        Ok(text) if text == plan.text() => return Ok(()),
        Ok(_) if crate::journal::journals(folder)?.is_empty() => {
            return Err(SweepError::Input(format!(
                "`{}` is another plan, and no sweep has been here; choose another folder",
                path.display()
            )));
        }
        Ok(_) | Err(_) => {}
    }
    interplay_files::write(&path, plan.text().as_bytes()).map_err(SweepError::file("write", &path))
}

/// Writes the table of a whole plan again, with the runs in the journals and those of people.
pub(crate) fn write_again(plan: &SweepPlan, folder: &Path) -> Result<(), SweepError> {
    let known = JournalIndex::read(folder)?;
    let part = Part::of(plan, Shard::WHOLE, &known, &|| ())?;
    write_table(plan, Shard::WHOLE, folder, &known, &part.runs).map(|_| ())
}

/// Writes the rows of the sorted keys from the journals, and for a whole plan the rows of people. Returns the number of rows
/// and the number without a result.
fn write_table(
    plan: &SweepPlan,
    shard: Shard,
    folder: &Path,
    index: &JournalIndex,
    runs: &[(RunKey, u64)],
) -> Result<(usize, usize), SweepError> {
    let people = if shard == Shard::WHOLE { rows(folder)? } else { Vec::new() };
    let mut inputs = inputs(plan);
    if !people.is_empty() {
        inputs.extend(COLUMNS.map(|name| (name.to_owned(), ColumnKind::Number)));
    }
    let about = [(PLAN_NOTE, plan_digest(plan)), (SHARD_NOTE, shard.to_string())];
    let mut unfinished = 0;
    let made = index.rows(runs).map(|row| row.map(|(row, number)| row.labelled(plan.point(number))));
    let made = made.chain(people.into_iter().map(Ok)).inspect(|row| {
        unfinished += usize::from(row.as_ref().is_ok_and(|row| row.error.is_some()));
    });
    let count = write_rows(&table_path(folder, shard), &inputs, plan.metrics(), &about, made)?;
    Ok((count, unfinished))
}
