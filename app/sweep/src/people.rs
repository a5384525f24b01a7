//! Rows of runs in which a person drove, in addition to those of a plan.
//!
//! They have a separate journal in the folder of a sweep, and its table includes them whenever it is written. A person is recorded
//! only as a number.

use std::path::{Path, PathBuf};

use interplay_scenarios::{Scenario, SweepPlan, SweepPoint};
use serde_json::{Value as Json, json};

use crate::error::SweepError;
use crate::journal::Journal;
use crate::key::{RunKey, program_version};
use crate::measure::measured_run;
use crate::people_rows::{PARTICIPANT, RESTARTS, path_in, rows};
use crate::row::SweepRow;
use crate::sweep::write_again;

/// The name of a person in a row.
const PERSON: &str = "person";

/// A run in which a person drove.
#[derive(Debug)]
pub struct PersonRun<'a> {
    /// The run of the plan from which it started.
    pub point: SweepPoint,
    /// The vehicle that the person drove.
    pub seat: &'a str,
    /// The number of the person.
    pub participant: u32,
    /// Number of restarts.
    pub restarts: u32,
    /// The played run, as a scenario that repeats it.
    pub played: &'a Scenario,
}

/// The rows of people in a folder. Only one process can open them.
pub struct PeopleRows {
    folder: PathBuf,
    journal: Journal,
    participants: u32,
}

impl PeopleRows {
    /// Opens the rows of people in the folder of a sweep.
    ///
    /// # Errors
    /// [`SweepError::InUse`] if another process has opened them, or if a file cannot be read.
    pub fn open(folder: &Path) -> Result<PeopleRows, SweepError> {
        let journal = Journal::open(&path_in(folder))?;
        let number = |row: &SweepRow| row.inputs.get(PARTICIPANT).and_then(Json::as_u64);
        let participants = rows(folder)?.iter().filter_map(number).max().unwrap_or_default();
        Ok(PeopleRows { folder: folder.to_owned(), journal, participants: participants as u32 })
    }

    /// Assigns the number of the next participant, counted from 1.
    pub fn begin_participant(&mut self) -> u32 {
        self.participants += 1;
        self.participants
    }

    /// Repeats a played run to make its row, and rewrites the table of the folder.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn add(&mut self, plan: &SweepPlan, run: &PersonRun<'_>) -> Result<(), SweepError> {
        let row = measured(plan, run)?;
        self.journal.append(&row)?;
        self.journal.sync()?;
        write_again(plan, &self.folder)
    }
}

/// The row of a run. A person takes the place of the planner or, in a vehicle other than the ego, of the style.
fn measured(plan: &SweepPlan, run: &PersonRun<'_>) -> Result<SweepRow, SweepError> {
    let (participant, number) = (run.participant.to_string(), u64::from(run.participant));
    let written = run.played.to_file().to_toml();
    let key = RunKey::of_parts(&[&program_version(), PERSON, &participant, &run.point.index.to_string(), &written]);
    let mut point = run.point.clone();
    point.inputs.extend([(PARTICIPANT.to_owned(), json!(number)), (RESTARTS.to_owned(), json!(run.restarts))]);
    let is_ego = run.played.ego().is_some_and(|ego| ego.name == run.seat);
    if is_ego {
        point.planner = PERSON.to_owned();
    } else {
        point.style = PERSON.to_owned();
        // The sample number identifies the person, so that comparisons pair the runs of one person.
        point.sample += number * plan.run_count();
    }
    let row = measured_run(key, &point, run.played, None)?;
    Ok(if is_ego { SweepRow { plan_median_ms: None, plan_p99_ms: None, ..row } } else { row })
}
