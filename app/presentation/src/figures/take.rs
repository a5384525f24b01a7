//! A take: a run of a scenario and all that was seen of it.

use std::sync::{Arc, Mutex, PoisonError};

use interplay_scenarios::{Override, Scenario, load};
use interplay_simulation::frame::Frame;
use interplay_simulation::report::Report;
use interplay_simulation::run::{RunError, run};
use interplay_simulation::watch::Watcher;

/// A run that a figure needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shot {
    /// What tells it apart from the others of its figure.
    pub label: &'static str,
    /// Name of the authored scenario.
    pub scenario: &'static str,
    /// What is changed in it, as `--set` has it.
    pub sets: &'static [&'static str],
}

/// How a run went.
#[derive(Clone, Debug, PartialEq)]
pub struct Ran {
    /// The words of the command that runs the same.
    pub command: Vec<String>,
    /// Whether its expectations held; `None` if the scenario was changed or expects nothing.
    pub held: Option<bool>,
}

/// A run and all that was seen of it.
#[derive(Clone, Debug)]
pub struct Take {
    /// What tells it apart from others beside it.
    pub label: String,
    /// The words of the command that runs the same.
    pub command: Vec<String>,
    /// What was run.
    pub scenario: Scenario,
    /// Every tick.
    pub frames: Vec<Frame>,
    /// What it amounts to.
    pub report: Report,
}

impl Shot {
    /// Runs it.
    ///
    /// # Errors
    /// In words, if the scenario cannot be loaded or its run cannot be finished.
    pub fn take(&self) -> Result<Take, String> {
        let changes: Vec<Override> = self.sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
        let scenario = load(self.scenario, &changes).map_err(|error| {
            let problems = error.faults().iter().map(ToString::to_string).collect::<Vec<_>>();
            format!("{error}: {}", problems.join("; "))
        })?;
        let sets = self.sets.iter().flat_map(|set| ["--set", set]);
        let command = ["interplay", "run", self.scenario].into_iter().chain(sets).map(str::to_owned).collect();
        Take::of(self.scenario, scenario, command, self.label).map_err(|error| error.to_string())
    }
}

impl Take {
    /// Runs a scenario, called `name` in the report, and keeps what is seen.
    ///
    /// # Errors
    /// [`RunError`].
    pub fn of(name: &str, scenario: Scenario, command: Vec<String>, label: &str) -> Result<Take, RunError> {
        let camera = Camera::default();
        let report = run(name, &scenario, vec![Box::new(camera.clone())])?;
        Ok(Take { label: label.to_owned(), command, scenario, frames: camera.frames(), report })
    }
}

impl Take {
    /// Whether it was changed, so that the authored expectations may not hold.
    pub fn changed(&self) -> bool {
        self.command.iter().any(|word| word == "--set" || word == "--planner")
    }

    /// How it went.
    pub fn ran(&self) -> Ran {
        let judged = !self.changed() && !self.report.expectations.is_empty();
        Ran { command: self.command.clone(), held: judged.then_some(self.report.passed) }
    }
}

/// A watcher that keeps what it is shown; its clones share what they keep.
#[derive(Clone, Debug, Default)]
pub struct Camera(Arc<Mutex<Vec<Frame>>>);

impl Camera {
    /// The frames so far, which the camera then has no longer.
    pub fn frames(&self) -> Vec<Frame> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Watcher for Camera {
    fn tick(&mut self, frame: &Frame) -> Result<(), String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(frame.clone());
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), String> {
        Ok(())
    }
}
