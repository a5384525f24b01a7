//! The rows of a folder, with the columns that a comparison needs.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use interplay_tables::{RowTable, TableColumn};

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
    /// Whether the run has a result.
    pub fn is_finished(&self) -> bool {
        !self.digest.is_empty()
    }

    /// Whether the run has vehicles.
    pub fn has_vehicles(&self) -> bool {
        self.number("contacts").is_some()
    }

    /// The number in a column, with flags as 0 and 1; `None` if the value is missing or if the table lacks the column,
    /// as tables of older versions may.
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

    /// The conditions of the run apart from the planner: scenario, style, sample and seed. Runs with the same conditions form a pair.
    pub fn conditions(&self) -> Conditions {
        (Arc::clone(&self.scenario), Arc::clone(&self.style), self.sample, self.seed)
    }
}

/// Scenario, style, sample and seed.
pub(super) type Conditions = (Arc<str>, Arc<str>, u64, u64);

/// The rows of a folder, and the versions of the program that made them.
pub(super) struct Records {
    pub all: Vec<RunRecord>,
    pub versions: Vec<String>,
}

impl Records {
    /// Reads the rows of a folder or a file: the columns that identify each row, and the requested ones.
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
