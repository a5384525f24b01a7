//! One run: a scenario in, a report out.

use std::time::Instant;

use bevy_ecs::prelude::*;
use interplay_scenarios::{Counterfactual, Scenario};
use rayon::prelude::*;
use thiserror::Error;

use crate::climate::{Building, BuildingError, BuildingFailure};
use crate::components::CurrentFrame;
use crate::frame::Frame;
use crate::measure::{BuildingMeasures, Measures};
use crate::report::Report;
use crate::time_points::time_points;
use crate::watch::{WatchError, Watcher, Watchers};
use crate::{phases, spawn};

/// Why a run could not be finished.
#[derive(Debug, Error)]
pub enum RunError {
    /// What was to be kept of it could not be kept.
    #[error("{0}")]
    Watch(WatchError),
    /// The building cannot be built.
    #[error("the building cannot be simulated: {0}")]
    Building(#[from] BuildingError),
    /// The building's controller gave up, or the program that is the building did not answer as agreed.
    #[error("the run ended on day {day}: {reason}")]
    Climate {
        /// The day, from 1.
        day: usize,
        /// Why.
        reason: BuildingFailure,
    },
    /// A run beside the scenario's own could not be finished.
    #[error("the counterfactual \"{name}\" could not be finished: {reason}")]
    Counterfactual {
        /// What it claims.
        name: String,
        /// Why.
        reason: Box<RunError>,
    },
    /// The loop itself is broken.
    #[error("the loop could not be built: {0}")]
    Loop(String),
}

/// Runs `scenario`, called `name` in the report, in front of `watchers`.
///
/// The result depends on the scenario alone (its seed included), and on the program that is the building if there is one: only
/// wall times differ from run to run.
///
/// # Errors
/// [`RunError`] if the schedule cannot be built or a watcher fails.
pub fn run(name: &str, scenario: &Scenario, watchers: Vec<Box<dyn Watcher>>) -> Result<Report, RunError> {
    let began = Instant::now();
    let mut world = spawn::world(scenario, watchers)?;
    let mut schedule = phases::schedule();
    let built = schedule.initialize(&mut world);
    built.map_err(|error| RunError::Loop(error.to_string(schedule.graph(), &world)))?;
    for (tick, time_point) in time_points(scenario).enumerate() {
        world.resource_mut::<CurrentFrame>().0 = Frame { tick, time_s: time_point.time_s, ..Frame::default() };
        world.insert_resource(time_point);
        schedule.run(&mut world);
        if let Some(mut building) = world.get_resource_mut::<Building>()
            && let Some(reason) = building.failure.take()
        {
            return Err(RunError::Climate { day: (building.step - 1) / building.steps_per_day() + 1, reason });
        }
    }
    let wall_s = began.elapsed().as_secs_f64();
    let watchers = world.remove_resource::<Watchers>().unwrap_or_default();
    watchers.finish().map_err(RunError::Watch)?;
    let measures = (world.resource::<Measures>(), world.get_resource::<BuildingMeasures>());
    Ok(Report::new(name, scenario, measures, wall_s))
}

/// Runs `scenario` as [`run`] does, then its counterfactuals side by side, and judges all of them. The scenario's own run is
/// the same bit for bit with and without them; watchers see nothing else.
///
/// # Errors
/// As [`run`]; [`RunError::Counterfactual`] if one of the other runs cannot be finished.
pub fn run_with_counterfactuals(
    name: &str,
    scenario: &Scenario,
    watchers: Vec<Box<dyn Watcher>>,
) -> Result<Report, RunError> {
    let mut report = run(name, scenario, watchers)?;
    let other = |counterfactual: &Counterfactual| {
        let unfinished =
            |reason| RunError::Counterfactual { name: counterfactual.stated.name.clone(), reason: Box::new(reason) };
        run(name, &counterfactual.scenario, Vec::new()).map_err(unfinished)
    };
    let runs =
        scenario.counterfactuals.par_iter().with_max_len(1).map(other).collect::<Result<Vec<Report>, RunError>>()?;
    report.judge_counterfactuals(scenario, runs);
    Ok(report)
}
