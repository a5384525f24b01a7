//! The rows of a folder, as far as a comparison needs them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use interplay_scenarios::RegisteredMetrics;
use interplay_tables::{RowTable, TableColumn};
use rayon::prelude::*;
use serde::Serialize;

use super::compared::ComparedColumns;
use super::pairs::{PairedDifference, correct};
use crate::error::SweepError;
use crate::sweep::RUNS_FILE;

/// The columns that tables of all versions have.
const TEXTS: [&str; 6] = ["version", "scenario", "family", "style", "planner", "digest"];
const COUNTS: [&str; 2] = ["sample", "seed"];

#[derive(Clone, Debug)]
pub(super) struct RunRecord {
    pub scenario: Arc<str>,
    pub family: Arc<str>,
    pub style: Arc<str>,
    pub planner: Arc<str>,
    pub sample: u64,
    pub seed: u64,
    /// Empty for an unfinished run.
    pub digest: String,
    /// The table that holds it, and its index.
    table: Arc<RowTable>,
    row: usize,
}

impl RunRecord {
    /// Whether there is a result.
    pub fn is_finished(&self) -> bool {
        !self.digest.is_empty()
    }

    /// Whether there are vehicles.
    pub fn has_vehicles(&self) -> bool {
        self.number("contacts").is_some()
    }

    /// The value in a column of numbers, flags as 0 and 1; none if it is missing or the table does not have the column, as tables
    /// of older versions.
    pub fn number(&self, column: &str) -> Option<f64> {
        match self.table.column(column)? {
            TableColumn::Flags(all) => all[self.row].map(f64::from),
            TableColumn::Counts(all) => all[self.row].map(|count| count as f64),
            TableColumn::Numbers(all) => all[self.row],
            TableColumn::Texts(_) => None,
        }
    }

    /// Whether a flag is set, or a count is not 0.
    pub fn flag(&self, column: &str) -> Option<bool> {
        self.number(column).map(|number| number != 0.0)
    }

    pub fn text(&self, column: &str) -> Option<&str> {
        match self.table.column(column)? {
            TableColumn::Texts(all) => all[self.row].as_deref(),
            _ => None,
        }
    }

    /// The conditions of the run apart from the planner, which identify its pair: scenario, style, sample and seed.
    pub fn conditions(&self) -> Conditions {
        (Arc::clone(&self.scenario), Arc::clone(&self.style), self.sample, self.seed)
    }
}

/// Scenario, style, sample and seed.
pub(super) type Conditions = (Arc<str>, Arc<str>, u64, u64);

/// The rows of a folder and the versions of the program that made them.
pub(super) struct Records {
    pub all: Vec<RunRecord>,
    pub versions: Vec<String>,
}

impl Records {
    /// Reads the rows of a folder or a file: the columns that identify rows, and these columns.
    pub fn read<'a>(path: &Path, columns: impl Iterator<Item = &'a str>) -> Result<Records, SweepError> {
        let file = if path.is_dir() { path.join(RUNS_FILE) } else { path.to_owned() };
        if !file.is_file() {
            return Err(SweepError::Input(format!(
                "there are no rows at `{}`; `interplay sweep` makes them, and `interplay sweep merge` of shards",
                file.display()
            )));
        }
        let names: Vec<String> = TEXTS.into_iter().chain(COUNTS).chain(columns).map(str::to_owned).collect();
        let table = RowTable::read(&file, &names)?;
        Records::of(table).map_err(|column| {
            SweepError::Input(format!("`{}` is not a table of runs: it has no column `{column}`", file.display()))
        })
    }

    /// The rows of a table; the error is the name of a missing column.
    fn of(table: RowTable) -> Result<Records, &'static str> {
        let missing_text = |name: &&str| !matches!(table.column(name), Some(TableColumn::Texts(_)));
        let missing_count = |name: &&str| !matches!(table.column(name), Some(TableColumn::Counts(_)));
        let missing = TEXTS.into_iter().find(missing_text).or_else(|| COUNTS.into_iter().find(missing_count));
        if let Some(missing) = missing {
            return Err(missing);
        }
        let table = Arc::new(table);
        let mut words = Words::default();
        let mut versions = BTreeSet::new();
        let nowhere: Arc<str> = "".into();
        let empty = RunRecord {
            scenario: Arc::clone(&nowhere),
            family: Arc::clone(&nowhere),
            style: Arc::clone(&nowhere),
            planner: nowhere,
            sample: 0,
            seed: 0,
            digest: String::new(),
            table: Arc::clone(&table),
            row: 0,
        };
        let all = (0..table.row_count).map(|row| {
            let at = RunRecord { row, ..empty.clone() };
            versions.extend(at.text("version").map(str::to_owned));
            let mut word = |column| words.shared(at.text(column).unwrap_or_default());
            let [scenario, family, style, planner] = ["scenario", "family", "style", "planner"].map(&mut word);
            let count = |column| match at.table.column(column) {
                Some(TableColumn::Counts(all)) => all[row].unwrap_or_default(),
                _ => 0,
            };
            let (sample, seed) = (count("sample"), count("seed"));
            let digest = at.text("digest").unwrap_or_default().to_owned();
            RunRecord { scenario, family, style, planner, sample, seed, digest, ..at }
        });
        let all = all.collect();
        Ok(Records { all, versions: versions.into_iter().collect() })
    }
}

/// Deduplicates texts that many rows share.
#[derive(Default)]
struct Words(HashMap<String, Arc<str>>);

impl Words {
    fn shared(&mut self, word: &str) -> Arc<str> {
        if let Some(known) = self.0.get(word) {
            return Arc::clone(known);
        }
        let shared: Arc<str> = word.into();
        self.0.insert(word.to_owned(), Arc::clone(&shared));
        shared
    }
}

/// Differences of the second folder from the first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VersionComparison {
    /// The versions of the program, of the first folder and of the second.
    pub versions: [Vec<String>; 2],
    /// Number of rows without a pair, in the first folder and in the second.
    pub unpaired: [usize; 2],
    /// Number of pairs of runs.
    pub pairs: usize,
    /// Number of pairs that differ in any bit of any state.
    pub changed: usize,
    /// Whether there are vehicles in any run.
    pub has_vehicles: bool,
    /// Each family, style and planner.
    pub groups: Vec<VersionGroup>,
}

/// A planner under the same conditions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VersionGroup {
    pub family: String,
    /// The drivers of the other vehicles.
    pub style: String,
    pub planner: String,
    /// Number of pairs that differ in any bit of any state.
    pub changed: usize,
    /// The second folder relative to the first: wins are those of the second.
    pub difference: PairedDifference,
}

/// Compares the rows of two folders or files: pairs have the same scenario, style, planner, sample and seed. `registered` metrics are compared, too.
///
/// # Errors
/// If a file cannot be read or is not a table of runs, or if no runs form a pair.
pub fn compare_versions(
    first: &Path,
    second: &Path,
    registered: &RegisteredMetrics,
) -> Result<VersionComparison, SweepError> {
    let compared = ComparedColumns::new(registered);
    let read = |path| Records::read(path, compared.columns());
    let [before, after] = [read(first)?, read(second)?];
    type Key<'a> = (Conditions, &'a str);
    let known: HashMap<Key<'_>, &RunRecord> =
        before.all.iter().map(|record| ((record.conditions(), &*record.planner), record)).collect();
    let mut groups: BTreeMap<[&str; 3], Vec<(&RunRecord, &RunRecord)>> = BTreeMap::new();
    let mut pairs = 0;
    for record in &after.all {
        if let Some(other) = known.get(&(record.conditions(), &*record.planner)) {
            pairs += 1;
            groups.entry([&record.family, &record.style, &record.planner]).or_default().push((record, other));
        }
    }
    if pairs == 0 {
        let [one, other] = [first, second].map(|path| path.display());
        return Err(SweepError::Input(format!(
            "no run of `{other}` has a pair in `{one}`: they are of different plans"
        )));
    }
    let groups: Vec<([&str; 3], Vec<_>)> = groups.into_iter().collect();
    let mut groups: Vec<VersionGroup> = groups
        .par_iter()
        .enumerate()
        .map(|(index, ([family, style, planner], pairs))| VersionGroup {
            family: (*family).to_owned(),
            style: (*style).to_owned(),
            planner: (*planner).to_owned(),
            changed: pairs.iter().filter(|(one, other)| one.digest != other.digest).count(),
            difference: PairedDifference::of(pairs, &compared, index as u64),
        })
        .collect();
    let mut differences: Vec<&mut PairedDifference> = groups.iter_mut().map(|group| &mut group.difference).collect();
    correct(&mut differences);
    Ok(VersionComparison {
        versions: [before.versions, after.versions],
        unpaired: [before.all.len() - pairs, after.all.len() - pairs],
        pairs,
        has_vehicles: after.all.iter().any(|record| record.has_vehicles()),
        changed: groups.iter().map(|group| group.changed).sum(),
        groups,
    })
}
