//! A study: people drive the runs of a plan one after another, and their runs become rows like those of the planners.

use std::path::Path;

use interplay_scenarios::{Scenario, SweepPlan, SweepPoint};
use interplay_sweep::{PeopleRows, PersonRun, RunKey, SweepError};
use serde::Serialize;
use thiserror::Error;

use crate::session::{Session, SessionError, check_seats};

const MAX_TRIALS: usize = 500;
/// Most runs of a plan, including those of planners.
const MAX_RUNS: u64 = 50_000;

#[derive(Debug, Error)]
pub enum StudyError {
    /// A run of the plan is refused, or its row cannot be written.
    #[error(transparent)]
    Plan(#[from] SweepError),
    /// A seat is not possible.
    #[error(transparent)]
    Seats(#[from] SessionError),
    /// No scenario has a seat.
    #[error("no scenario of the plan has a vehicle `{0}`; --as names vehicles, after commas")]
    NoSuchSeat(String),
    /// A scenario has none of the seats.
    #[error("`{scenario}` has none of the seats {seats}; name one of each scenario with --as, after commas")]
    NoSeatHere { scenario: String, seats: String },
    /// The plan has too many runs.
    #[error("the plan has {0} runs; a study has at most {MAX_RUNS}; lower its `samples`")]
    TooLarge(u64),
    /// A person would have to drive too many runs.
    #[error("each person would have to drive {0} runs; at most {MAX_TRIALS} are possible; lower `samples` of the plan")]
    TooMany(usize),
}

/// The runs that each participant of a study drives, before the folder of its results is opened.
pub struct PlannedStudy {
    plan: SweepPlan,
    trials: Vec<Trial>,
    minutes: f64,
}

/// A study in progress: participants drive the runs of a plan, and each finished run becomes a row of the results.
pub struct Study {
    planned: PlannedStudy,
    rows: PeopleRows,
    now: Option<Participant>,
}

/// A run of the plan and the seat of the person.
#[derive(Clone, Debug)]
struct Trial {
    index: u64,
    seat: String,
}

struct Participant {
    number: u32,
    trials: Vec<Trial>,
    done: usize,
    restarts: u32,
}

/// The progress of a person in a study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StudyPlace {
    /// The number of the person; `None` before the person has agreed.
    pub participant: Option<u32>,
    pub done: usize,
    pub of: usize,
    /// Duration of all runs \[min\].
    pub minutes: f64,
}

impl PlannedStudy {
    /// Plans a study with the runs of a plan. In each scenario a person drives in all the given seats that it has, or without seats as
    /// the ego. As the ego the person replaces the planner, otherwise the driver of a style; of several planners or styles only the
    /// runs of the first are driven.
    ///
    /// # Errors
    /// [`StudyError`] if a run or a seat is refused, or if there are too many.
    pub fn of(plan: SweepPlan, seats: &[&str]) -> Result<PlannedStudy, StudyError> {
        let (trials, duration_s) = trials_of(&plan, seats)?;
        Ok(PlannedStudy { plan, trials, minutes: duration_s / 60.0 })
    }

    pub fn plan(&self) -> &SweepPlan {
        &self.plan
    }

    /// Opens the rows of people in the folder with the rows of the planners.
    ///
    /// # Errors
    /// [`SweepError`] if they cannot be read, or the folder is in use.
    pub fn open(self, folder: &Path) -> Result<Study, SweepError> {
        Ok(Study { planned: self, rows: PeopleRows::open(folder)?, now: None })
    }
}

/// The scenario of a run of a plan.
fn scenario_of(plan: &SweepPlan, point: &SweepPoint) -> Result<Scenario, SweepError> {
    plan.scenario(point).map_err(|error| SweepError::Refused(Box::new(error)))
}

impl Study {
    /// The progress of the present person.
    pub fn place(&self) -> StudyPlace {
        StudyPlace {
            participant: self.now.as_ref().map(|person| person.number),
            done: self.now.as_ref().map_or(0, |person| person.done),
            of: self.planned.trials.len(),
            minutes: self.planned.minutes,
        }
    }

    /// Begins with a new person. The order of the runs depends on the number of the person and on the plan.
    pub fn begin(&mut self) {
        let number = self.rows.begin_participant();
        let mut trials = self.planned.trials.clone();
        let place = |trial: &Trial| {
            RunKey::of_parts(&[self.planned.plan.text(), &number.to_string(), &trial.index.to_string(), &trial.seat])
        };
        trials.sort_by_cached_key(place);
        self.now = Some(Participant { number, trials, done: 0, restarts: 0 });
    }

    pub fn leave(&mut self) {
        self.now = None;
    }

    /// Counts a restart of the present run.
    pub fn count_restart(&mut self) {
        if let Some(person) = &mut self.now {
            person.restarts += 1;
        }
    }

    /// The next run and its seat; `None` without a person or after the last run.
    ///
    /// # Errors
    /// [`SweepError`] if the run is refused.
    pub fn next(&self) -> Result<Option<(String, Scenario, String)>, SweepError> {
        let trial = self.now.as_ref().and_then(|person| person.trials.get(person.done));
        let Some(trial) = trial else { return Ok(None) };
        let point = self.planned.plan.point(trial.index);
        let scenario = scenario_of(&self.planned.plan, &point)?;
        Ok(Some((point.scenario, scenario, trial.seat.clone())))
    }

    /// Adds a finished run to the results, as a row.
    ///
    /// # Errors
    /// [`SweepError`] if the row cannot be written.
    pub fn add(&mut self, session: &Session) -> Result<(), SweepError> {
        let Some(person) = &mut self.now else { return Ok(()) };
        let Some(trial) = person.trials.get(person.done) else { return Ok(()) };
        let run = PersonRun {
            point: self.planned.plan.point(trial.index),
            seat: &trial.seat,
            participant: person.number,
            restarts: std::mem::take(&mut person.restarts),
            played: &session.played(),
        };
        person.done += 1;
        self.rows.add(&self.planned.plan, &run)
    }
}

/// The runs that a person drives, and their total duration \[s\].
fn trials_of(plan: &SweepPlan, seats: &[&str]) -> Result<(Vec<Trial>, f64), StudyError> {
    if plan.run_count() > MAX_RUNS {
        return Err(StudyError::TooLarge(plan.run_count()));
    }
    let [_, styles, planners] = plan.names();
    let mut unseen: Vec<&str> = seats.to_vec();
    let (mut trials, mut duration_s) = (Vec::new(), 0.0);
    for index in 0..plan.run_count() {
        let point = plan.point(index);
        let scenario = scenario_of(plan, &point)?;
        let ego = scenario.ego().map(|ego| ego.name.clone()).unwrap_or_default();
        unseen.retain(|seat| scenario.index_of(seat).is_none());
        let there = seats_here(&point.scenario, &scenario, seats, &ego)?;
        for seat in there {
            let is_first = if seat == ego {
                planners.first().is_none_or(|first| *first == point.planner)
            } else {
                styles.first().is_none_or(|first| *first == point.style)
            };
            if is_first {
                duration_s += scenario.duration_s;
                trials.push(Trial { index, seat });
            }
        }
        if trials.len() > MAX_TRIALS {
            return Err(StudyError::TooMany(trials.len()));
        }
    }
    if let Some(seat) = unseen.first() {
        return Err(StudyError::NoSuchSeat((*seat).to_owned()));
    }
    Ok((trials, duration_s))
}

/// The seats of a scenario that people take.
fn seats_here(name: &str, scenario: &Scenario, seats: &[&str], ego: &str) -> Result<Vec<String>, StudyError> {
    let here: Vec<&str> = match seats {
        [] => vec![ego],
        seats => seats.iter().copied().filter(|seat| scenario.index_of(seat).is_some()).collect(),
    };
    if here.is_empty() {
        return Err(StudyError::NoSeatHere { scenario: name.to_owned(), seats: seats.join(", ") });
    }
    check_seats(name, scenario, &here)?;
    Ok(here.into_iter().map(str::to_owned).collect())
}
