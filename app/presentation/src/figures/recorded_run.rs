//! Runs with all their frames.

use std::sync::{Arc, Mutex, PoisonError};

use interplay_scenarios::{Override, Scenario, load};
use interplay_simulation::frame::Frame;
use interplay_simulation::report::Report;
use interplay_simulation::run::{RunError, run};
use interplay_simulation::watch::{WatchError, Watcher};

use super::lookup::FigureError;

/// A run that a figure needs.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RunSpec {
    /// Label that distinguishes this run from the others of its figure.
    pub label: String,
    pub scenario: String,
    /// Changes of the scenario, in the form of `--set`.
    pub sets: Vec<String>,
}

/// The command of a run and whether its expectations held.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOutcome {
    /// Words of the command that repeats the run.
    pub command: Vec<String>,
    /// Whether its expectations held; `None` if the scenario was changed or expects nothing.
    pub held: Option<bool>,
}

/// A finished run with all its frames and its report.
#[derive(Clone, Debug)]
pub struct RecordedRun {
    /// Label that distinguishes this run from others beside it.
    pub label: String,
    /// Words of the command that repeats the run.
    pub command: Vec<String>,
    pub scenario: Scenario,
    pub frames: Vec<Frame>,
    pub report: Report,
    /// End of the animation of the run \[s\]; by default it ends when nothing more happens.
    pub shown_until_s: Option<f64>,
}

impl RunSpec {
    /// A run of an authored scenario with changes.
    #[cfg(test)]
    pub(crate) fn new(label: &str, scenario: &str, sets: &[&str]) -> RunSpec {
        let sets = sets.iter().map(|set| (*set).to_owned()).collect();
        RunSpec { label: label.to_owned(), scenario: scenario.to_owned(), sets }
    }

    /// Runs the scenario and keeps all frames.
    ///
    /// # Errors
    /// [`FigureError`], if the scenario cannot be loaded or its run cannot be finished.
    pub fn record(&self) -> Result<RecordedRun, FigureError> {
        let changes: Vec<Override> = self.sets.iter().map(|set| Override::Set(set.clone())).collect();
        let scenario = load(&self.scenario, &changes)?;
        let sets = self.sets.iter().flat_map(|set| ["--set", set.as_str()]);
        let command = ["interplay", "run", self.scenario.as_str()].into_iter().chain(sets).map(str::to_owned).collect();
        Ok(RecordedRun::record(&self.scenario, scenario, command, &self.label)?)
    }
}

impl RecordedRun {
    /// A run that is only drawn, without label and command.
    pub fn to_draw(scenario: Scenario, frames: Vec<Frame>, report: Report) -> RecordedRun {
        RecordedRun { label: String::new(), command: Vec::new(), scenario, frames, report, shown_until_s: None }
    }

    /// Runs a scenario, called `name` in the report, and keeps all frames.
    pub fn record(name: &str, scenario: Scenario, command: Vec<String>, label: &str) -> Result<RecordedRun, RunError> {
        let frame_log = FrameLog::default();
        let report = run(name, &scenario, vec![Box::new(frame_log.clone())])?;
        let recorded = RecordedRun::to_draw(scenario, frame_log.frames(), report);
        Ok(RecordedRun { label: label.to_owned(), command, ..recorded })
    }
}

impl RecordedRun {
    /// Whether the scenario was changed, so that the authored expectations may not hold.
    pub fn changed(&self) -> bool {
        self.command.iter().any(|word| word == "--set" || word == "--planner")
    }

    /// The command of the run and whether its expectations held.
    pub fn ran(&self) -> RunOutcome {
        let judged = !self.changed() && !self.report.expectations.is_empty();
        RunOutcome { command: self.command.clone(), held: judged.then_some(self.report.passed) }
    }
}

/// A watcher that keeps all frames; its clones share them.
#[derive(Clone, Debug, Default)]
pub struct FrameLog(Arc<Mutex<Vec<Frame>>>);

impl FrameLog {
    /// Takes the frames so far out of the log.
    pub fn frames(&self) -> Vec<Frame> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Watcher for FrameLog {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(frame.clone());
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}
