//! One run: a scenario in, a report out.

use std::time::Instant;

use bevy::ecs::prelude::*;
use interplay_scenarios::Scenario;
use thiserror::Error;

use crate::measure::Measures;
use crate::report::Report;
use crate::watch::{Watcher, Watchers};
use crate::{phases, spawn};

/// Why a run could not be finished.
#[derive(Debug, Error)]
pub enum RunError {
    /// What was to be kept of it could not be kept.
    #[error("{0}")]
    Watch(String),
    /// The loop itself is broken.
    #[error("the loop could not be built: {0}")]
    Loop(String),
}

/// Runs `scenario`, called `name` in the report, in front of `watchers`.
///
/// The result depends on the scenario alone (its seed included): only wall times differ from run to run.
///
/// # Errors
/// [`RunError`] if the schedule cannot be built or a watcher fails.
pub fn run(name: &str, scenario: &Scenario, watchers: Vec<Box<dyn Watcher>>) -> Result<Report, RunError> {
    let began = Instant::now();
    let mut world = spawn::world(scenario, watchers);
    let mut schedule = phases::schedule();
    let built = schedule.initialize(&mut world);
    built.map_err(|error| RunError::Loop(error.to_string(schedule.graph(), &world)))?;
    for _ in 0..scenario.tick_count() {
        schedule.run(&mut world);
    }
    let wall_s = began.elapsed().as_secs_f64();
    let watchers = world.remove_resource::<Watchers>().unwrap_or_default();
    watchers.finish().map_err(RunError::Watch)?;
    Ok(Report::new(name, scenario, world.resource::<Measures>(), wall_s))
}
