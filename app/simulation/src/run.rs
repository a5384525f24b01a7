//! One run: a scenario in, a report out.

use interplay_scenarios::{Counterfactual, Scenario};
use rayon::prelude::*;
use thiserror::Error;

use crate::climate::{BuildingError, BuildingFailure};
use crate::report::Report;
use crate::simulation::Simulation;
use crate::watch::{WatchError, Watcher};
use crate::world_state::NotCopied;

/// Why a run could not be finished.
#[derive(Debug, Error)]
pub enum RunError {
    /// A watcher could not keep what it was shown.
    #[error("{0}")]
    Watch(WatchError),
    /// The building cannot be built.
    #[error("the building cannot be simulated: {0}")]
    Building(#[from] BuildingError),
    /// The building's controller gave up, or the program that is the building did not answer as agreed.
    #[error("the run ended on day {day}: {reason}")]
    Climate {
        /// Number of the day, from 1.
        day: usize,
        /// The reason.
        reason: BuildingFailure,
    },
    /// A run beside the scenario's own could not be finished.
    #[error("the counterfactual \"{name}\" could not be finished: {reason}")]
    Counterfactual {
        /// Claim of the counterfactual.
        name: String,
        /// The reason.
        reason: Box<RunError>,
    },
    /// No vehicle has this name.
    #[error("there is no vehicle `{vehicle}`; the vehicles are {names}")]
    NoVehicle {
        /// The name.
        vehicle: String,
        /// The names that there are.
        names: String,
    },
    /// A vehicle whose driver is external was given no input.
    #[error("`{vehicle}` is driven from outside, and was given no input for the tick at {time_s} s")]
    NoInput {
        /// The vehicle.
        vehicle: String,
        /// Time at which the tick begins \[s\].
        time_s: f64,
    },
    /// An input was handed in for a vehicle that decides for itself.
    #[error("`{vehicle}` has a driver of its own; `driver = {{ kind = \"external\" }}` lets it be driven from outside")]
    NotExternal {
        /// The vehicle.
        vehicle: String,
    },
    /// An input is not a finite number.
    #[error("the input for `{vehicle}` is not finite")]
    NotFinite {
        /// The vehicle.
        vehicle: String,
    },
    /// A plan has the wrong length.
    #[error("the plan for `{vehicle}` has {found} inputs, and the horizon is {steps} steps")]
    WrongPlan {
        /// The vehicle.
        vehicle: String,
        /// The inputs that it has.
        found: usize,
        /// The steps of the scenario's horizon.
        steps: usize,
    },
    /// A part of the world cannot be copied.
    #[error(transparent)]
    NotCopied(#[from] NotCopied),
    /// An earlier step has failed.
    #[error("the run has ended with an error: restore a snapshot, or begin anew")]
    Ended,
    /// The loop could not be run.
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
    let mut simulation = Simulation::watched(name, scenario, watchers)?;
    while simulation.step()?.is_some() {}
    simulation.finish()
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
