//! A study: people are walked through the runs of a plan, and what they did is rows beside those of the planners.

use std::path::Path;

use interplay_scenarios::{LoadError, Scenario, SweepPlan};
use interplay_sweep::{PeopleRows, PersonRun, RunKey, SweepError};
use serde::Serialize;
use thiserror::Error;

use crate::session::{Session, SessionError, check_seats};

/// Most runs that one person is asked to drive.
const MOST_TRIALS: usize = 500;
/// Most runs of a plan, the others of which planners make.
const MOST_RUNS: u64 = 50_000;

/// Why there is no study.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A run of the plan is refused.
    #[error("{0}")]
    Plan(Box<LoadError>),
    /// Nobody could sit there.
    #[error(transparent)]
    Seats(#[from] SessionError),
    /// No scenario has a seat.
    #[error("no scenario of the plan has a vehicle `{0}`; --as names vehicles, after commas")]
    NoSuchSeat(String),
    /// A scenario has none of the seats.
    #[error("`{scenario}` has none of the seats {seats}; name one of each scenario with --as, after commas")]
    NoSeatHere {
        /// The scenario.
        scenario: String,
        /// The seats that were asked for.
        seats: String,
    },
    /// Planners would drive for ever.
    #[error("the plan has {0} runs, and {MOST_RUNS} are most in a study; lower its `samples`")]
    TooLarge(u64),
    /// A person cannot drive so much.
    #[error("each person would have to drive {0} runs, and {MOST_TRIALS} are most; lower `samples` of the plan")]
    TooMany(usize),
    /// The rows cannot be read or written.
    #[error(transparent)]
    Rows(#[from] SweepError),
}

/// People who drive the runs of a plan, one after another.
pub struct Study {
    plan: SweepPlan,
    rows: PeopleRows,
    /// What each person drives, before it is shuffled.
    trials: Vec<Trial>,
    minutes: f64,
    now: Option<Participant>,
}

/// A run of the plan and the seat in it.
#[derive(Clone, Debug)]
struct Trial {
    index: u64,
    seat: String,
}

/// A person and how far it has come.
struct Participant {
    number: u32,
    trials: Vec<Trial>,
    done: usize,
    restarts: u32,
}

/// Where in a study somebody is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StudyPlace {
    /// The number of the person; none before the person has agreed.
    pub participant: Option<u32>,
    /// How many runs are done.
    pub done: usize,
    /// How many there are.
    pub of: usize,
    /// How long all of them take \[min\].
    pub minutes: f64,
}

impl Study {
    /// A study with the runs of a plan whose rows are in a folder. A person takes one of the seats, in each scenario every one that it
    /// has; without any, the ego. The person stands in for the planner if that is the ego, and otherwise for the style: of several
    /// planners or styles that it stands in for, the first is driven.
    ///
    /// # Errors
    /// [`StudyError`] if a run or a seat is refused, they are too many, or the folder is in use.
    pub fn new(plan: SweepPlan, folder: &Path, seats: &[&str]) -> Result<Study, StudyError> {
        let (trials, duration_s) = trials_of(&plan, seats)?;
        let rows = PeopleRows::open(folder)?;
        Ok(Study { plan, rows, trials, minutes: duration_s / 60.0, now: None })
    }

    /// Checks a plan and its seats as [`Study::new`] does, before there is a folder.
    ///
    /// # Errors
    /// [`StudyError`] if a run or a seat is refused, or they are too many.
    pub fn check(plan: &SweepPlan, seats: &[&str]) -> Result<(), StudyError> {
        trials_of(plan, seats).map(|_| ())
    }

    /// Where in it somebody is.
    pub fn place(&self) -> StudyPlace {
        StudyPlace {
            participant: self.now.as_ref().map(|person| person.number),
            done: self.now.as_ref().map_or(0, |person| person.done),
            of: self.trials.len(),
            minutes: self.minutes,
        }
    }

    /// Somebody agrees: the runs come in an order of their own, which the person's number and the plan decide.
    pub fn begin(&mut self) {
        let number = self.rows.begin_participant();
        let mut trials = self.trials.clone();
        let place = |trial: &Trial| {
            RunKey::of_parts(&[self.plan.text(), &number.to_string(), &trial.index.to_string(), &trial.seat])
        };
        trials.sort_by_cached_key(place);
        self.now = Some(Participant { number, trials, done: 0, restarts: 0 });
    }

    /// Nobody drives any more.
    pub fn leave(&mut self) {
        self.now = None;
    }

    /// The run is begun anew.
    pub fn begin_again(&mut self) {
        if let Some(person) = &mut self.now {
            person.restarts += 1;
        }
    }

    /// The next run and its seat; none where nobody drives or all is done.
    ///
    /// # Errors
    /// [`StudyError::Plan`] if the run is refused.
    pub fn next(&self) -> Result<Option<(String, Scenario, String)>, StudyError> {
        let trial = self.now.as_ref().and_then(|person| person.trials.get(person.done));
        let Some(trial) = trial else { return Ok(None) };
        let point = self.plan.point(trial.index);
        let scenario = self.plan.scenario(&point).map_err(|error| StudyError::Plan(Box::new(error)))?;
        Ok(Some((point.scenario, scenario, trial.seat.clone())))
    }

    /// A run is done: it becomes a row.
    ///
    /// # Errors
    /// [`StudyError::Rows`] if the row cannot be written.
    pub fn add(&mut self, session: &Session) -> Result<(), StudyError> {
        let Some(person) = &mut self.now else { return Ok(()) };
        let Some(trial) = person.trials.get(person.done) else { return Ok(()) };
        let run = PersonRun {
            point: self.plan.point(trial.index),
            seat: &trial.seat,
            participant: person.number,
            restarts: std::mem::take(&mut person.restarts),
            played: &session.played(),
        };
        person.done += 1;
        Ok(self.rows.add(&self.plan, &run)?)
    }
}

/// What a person drives of a plan, and how long that takes \[s\].
fn trials_of(plan: &SweepPlan, seats: &[&str]) -> Result<(Vec<Trial>, f64), StudyError> {
    if plan.run_count() > MOST_RUNS {
        return Err(StudyError::TooLarge(plan.run_count()));
    }
    let [_, styles, planners] = plan.names();
    let mut unseen: Vec<&str> = seats.to_vec();
    let (mut trials, mut duration_s) = (Vec::new(), 0.0);
    for index in 0..plan.run_count() {
        let point = plan.point(index);
        let scenario = plan.scenario(&point).map_err(|error| StudyError::Plan(Box::new(error)))?;
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
        if trials.len() > MOST_TRIALS {
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
