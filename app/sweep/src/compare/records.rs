//! The rows of a folder, as far as a comparison needs them.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use crate::error::SweepError;
use crate::sweep::RUNS_FILE;
use crate::table::{RowTable, TableColumn};

/// The columns that are read.
const COLUMNS: [&str; 32] = [
    "version",
    "scenario",
    "family",
    "style",
    "planner",
    "sample",
    "seed",
    "digest",
    "passed",
    "success",
    "completed_s",
    "deadlock",
    "contacts",
    "ego_contact",
    "contact_by_ego",
    "ego_place",
    "ego_yields",
    "ego_gap_m",
    "time_to_collision_s",
    "plans_failed",
    "plan_median_ms",
    "plan_p99_ms",
    "others_yield",
    "order_kept",
    "hard_braking",
    "others_hard_braking",
    "leaves_road",
    "energy_kwh",
    "electricity_kwh",
    "bill",
    "currency",
    "discomfort_k_h",
];

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RunRecord {
    pub scenario: Arc<str>,
    pub family: Arc<str>,
    pub style: Arc<str>,
    pub planner: Arc<str>,
    pub sample: u64,
    pub seed: u64,
    /// Empty for a run that was not finished.
    pub digest: String,
    pub success: bool,
    pub completed_s: Option<f64>,
    pub is_deadlock: bool,
    pub has_contact: bool,
    pub has_contact_by_ego: bool,
    /// Whether anybody touches anybody.
    pub has_any_contact: bool,
    /// The place of the ego, from 1.
    pub place: Option<u64>,
    /// Whether another went before the ego in a conflict zone.
    pub yields: bool,
    pub gap_m: Option<f64>,
    pub time_to_collision_s: Option<f64>,
    pub plans_failed: u64,
    pub plan_median_ms: Option<f64>,
    pub plan_p99_ms: Option<f64>,
    /// Whether there are vehicles.
    pub has_vehicles: bool,
    /// Whether the ego went before another in a conflict zone; none in rows of older versions, like what follows.
    pub others_yield: Option<bool>,
    /// Whether the order is that of the scenario's file and nobody touches anybody.
    pub is_order_kept: Option<bool>,
    pub brakes_hard: Option<bool>,
    /// Whether any other vehicle brakes hard.
    pub others_brake_hard: Option<bool>,
    /// Whether the ego leaves the road.
    pub leaves_road: Option<bool>,
    pub building: Option<BuildingRecord>,
}

/// What a row says of a building, over all its days.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BuildingRecord {
    pub energy_kwh: f64,
    pub discomfort_k_h: f64,
    pub electricity_kwh: Option<f64>,
    pub bill: Option<f64>,
    pub currency: Option<Arc<str>>,
}

impl RunRecord {
    /// Whether there is a result.
    pub fn is_finished(&self) -> bool {
        !self.digest.is_empty()
    }

    /// The other conditions of the run, which its pair has in common: scenario, style, sample and seed.
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
    /// Reads the rows of a folder, or of a file.
    pub fn read(path: &Path) -> Result<Records, SweepError> {
        let file = if path.is_dir() { path.join(RUNS_FILE) } else { path.to_owned() };
        if !file.is_file() {
            return Err(SweepError::Input(format!(
                "there are no rows at `{}`; `interplay sweep` makes them, and `interplay sweep merge` of shards",
                file.display()
            )));
        }
        let names = COLUMNS.map(str::to_owned);
        let table = RowTable::read(&file, &names)?;
        Records::of(&table).map_err(|column| {
            SweepError::Input(format!("`{}` is no table of runs: it has no column `{column}`", file.display()))
        })
    }

    /// The rows of a table; the name of a column that is missing.
    fn of(table: &RowTable) -> Result<Records, &'static str> {
        let columns = Columns { table };
        let mut words = Words::default();
        let [versions, scenarios, families] =
            [columns.texts("version")?, columns.texts("scenario")?, columns.texts("family")?];
        let [styles, planners, digests] =
            [columns.texts("style")?, columns.texts("planner")?, columns.texts("digest")?];
        let [samples, seeds, failed] =
            [columns.counts("sample")?, columns.counts("seed")?, columns.counts("plans_failed")?];
        let [places, yields] = [columns.counts("ego_place")?, columns.counts("ego_yields")?];
        let counts = columns.counts("contacts")?;
        let [passed, success, deadlocks] =
            [columns.flags("passed")?, columns.flags("success")?, columns.flags("deadlock")?];
        let [contacts, by_ego] = [columns.flags("ego_contact")?, columns.flags("contact_by_ego")?];
        let [completed, gaps] = [columns.numbers("completed_s")?, columns.numbers("ego_gap_m")?];
        let times = columns.numbers("time_to_collision_s")?;
        // Timings may have been left out.
        let [medians, tails] = ["plan_median_ms", "plan_p99_ms"].map(|name| columns.numbers(name).unwrap_or(&[]));
        let newer = NewerColumns::of(&columns);
        let mut word = |column: &[Option<String>], row: usize| words.shared(column[row].as_deref().unwrap_or_default());
        let all = (0..table.row_count).map(|row| RunRecord {
            scenario: word(scenarios, row),
            family: word(families, row),
            style: word(styles, row),
            planner: word(planners, row),
            sample: samples[row].unwrap_or_default(),
            seed: seeds[row].unwrap_or_default(),
            digest: digests[row].clone().unwrap_or_default(),
            success: success[row].or(passed[row]).unwrap_or(false),
            completed_s: completed[row],
            is_deadlock: deadlocks[row].unwrap_or(false),
            has_contact: contacts[row].unwrap_or(false),
            has_contact_by_ego: by_ego[row].unwrap_or(false),
            has_any_contact: counts[row].is_some_and(|count| count > 0),
            place: places[row],
            yields: yields[row].is_some_and(|count| count > 0),
            gap_m: gaps[row],
            time_to_collision_s: times[row],
            plans_failed: failed[row].unwrap_or(0),
            plan_median_ms: medians.get(row).copied().flatten(),
            plan_p99_ms: tails.get(row).copied().flatten(),
            has_vehicles: counts[row].is_some(),
            others_yield: newer.others_yield.get(row).copied().flatten().map(|count| count > 0),
            is_order_kept: newer.order_kept.get(row).copied().flatten(),
            brakes_hard: newer.hard_braking.get(row).copied().flatten(),
            others_brake_hard: newer.others_hard_braking.get(row).copied().flatten(),
            leaves_road: newer.leaves_road.get(row).copied().flatten(),
            building: newer.building(row),
        });
        let all = all.collect();
        let versions: BTreeSet<&str> = versions.iter().flatten().map(String::as_str).collect();
        Ok(Records { all, versions: versions.into_iter().map(str::to_owned).collect() })
    }
}

/// Columns that tables of older versions do not have; empty there.
struct NewerColumns<'a> {
    others_yield: &'a [Option<u64>],
    order_kept: &'a [Option<bool>],
    hard_braking: &'a [Option<bool>],
    others_hard_braking: &'a [Option<bool>],
    leaves_road: &'a [Option<bool>],
    energy_kwh: &'a [Option<f64>],
    discomfort_k_h: &'a [Option<f64>],
    electricity_kwh: &'a [Option<f64>],
    bill: &'a [Option<f64>],
    currency: &'a [Option<String>],
}

impl<'a> NewerColumns<'a> {
    fn of(columns: &Columns<'a>) -> Self {
        let flags = |name| columns.flags(name).unwrap_or(&[]);
        let numbers = |name| columns.numbers(name).unwrap_or(&[]);
        NewerColumns {
            others_yield: columns.counts("others_yield").unwrap_or(&[]),
            order_kept: flags("order_kept"),
            hard_braking: flags("hard_braking"),
            others_hard_braking: flags("others_hard_braking"),
            leaves_road: flags("leaves_road"),
            energy_kwh: numbers("energy_kwh"),
            discomfort_k_h: numbers("discomfort_k_h"),
            electricity_kwh: numbers("electricity_kwh"),
            bill: numbers("bill"),
            currency: columns.texts("currency").unwrap_or(&[]),
        }
    }

    /// What a row says of a building; none without one.
    fn building(&self, row: usize) -> Option<BuildingRecord> {
        let number = |column: &[Option<f64>]| column.get(row).copied().flatten();
        Some(BuildingRecord {
            energy_kwh: number(self.energy_kwh)?,
            discomfort_k_h: number(self.discomfort_k_h)?,
            electricity_kwh: number(self.electricity_kwh),
            bill: number(self.bill),
            currency: self.currency.get(row).and_then(|word| word.as_deref()).map(Arc::from),
        })
    }
}

/// Texts that many rows have in common.
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

/// The columns of a table by name and type.
struct Columns<'a> {
    table: &'a RowTable,
}

impl<'a> Columns<'a> {
    fn texts(&self, name: &'static str) -> Result<&'a [Option<String>], &'static str> {
        match self.table.column(name) {
            Some(TableColumn::Texts(all)) => Ok(all),
            _ => Err(name),
        }
    }

    fn counts(&self, name: &'static str) -> Result<&'a [Option<u64>], &'static str> {
        match self.table.column(name) {
            Some(TableColumn::Counts(all)) => Ok(all),
            _ => Err(name),
        }
    }

    fn numbers(&self, name: &'static str) -> Result<&'a [Option<f64>], &'static str> {
        match self.table.column(name) {
            Some(TableColumn::Numbers(all)) => Ok(all),
            _ => Err(name),
        }
    }

    fn flags(&self, name: &'static str) -> Result<&'a [Option<bool>], &'static str> {
        match self.table.column(name) {
            Some(TableColumn::Flags(all)) => Ok(all),
            _ => Err(name),
        }
    }
}
