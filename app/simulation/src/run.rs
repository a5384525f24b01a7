//! Runs a scenario and returns its report.

use interplay_scenarios::{Counterfactual, Scenario};
use rayon::prelude::*;

use crate::phases::watch::Watcher;
use crate::report::Report;
use crate::simulation::Simulation;

pub use crate::simulation::run_error::RunError;

/// Runs `scenario`, called `name` in the report, and passes its ticks to `watchers`.
///
/// The result depends only on the scenario (its seed included), and on the program that simulates the building if there is one. Only
/// wall times differ between runs.
///
/// # Errors
/// [`RunError`] if the schedule cannot be built or a watcher fails.
pub fn run(name: &str, scenario: &Scenario, watchers: Vec<Box<dyn Watcher>>) -> Result<Report, RunError> {
    run_unless(&|| false, name, scenario, watchers)
}

/// As [`run`], until `is_cancelled`, which is asked after each step.
///
/// # Errors
/// As [`run`]; [`RunError::Cancelled`].
pub fn run_unless(
    is_cancelled: &(dyn Fn() -> bool + Sync),
    name: &str,
    scenario: &Scenario,
    watchers: Vec<Box<dyn Watcher>>,
) -> Result<Report, RunError> {
    finished(is_cancelled, Simulation::watched(name, scenario, watchers)?)
}

/// Runs `scenario` as [`run`] does, then its counterfactuals in parallel, and judges all of them. The scenario's own run is
/// bit-identical with and without them; watchers receive nothing else.
///
/// # Errors
/// As [`run`]; [`RunError::Counterfactual`] if one of the counterfactual runs fails.
pub fn run_with_counterfactuals(
    name: &str,
    scenario: &Scenario,
    watchers: Vec<Box<dyn Watcher>>,
) -> Result<Report, RunError> {
    run_on_threads(1, name, scenario, watchers)
}

/// The same, in which the vehicles of the scenario's own run decide on some threads; the result is the same with any number.
///
/// # Errors
/// As [`run_with_counterfactuals`]; [`RunError::Threads`] if the system has no threads.
pub fn run_on_threads(
    threads: usize,
    name: &str,
    scenario: &Scenario,
    watchers: Vec<Box<dyn Watcher>>,
) -> Result<Report, RunError> {
    let builder = Simulation::builder(scenario).with_name(name).with_watchers(watchers).with_threads(threads);
    let mut report = finished(&|| false, builder.build()?)?;
    add_counterfactuals(&|| false, name, scenario, &mut report)?;
    Ok(report)
}

/// Runs the counterfactuals of `scenario` in parallel, until `is_cancelled`, and judges them in the report of its own run.
///
/// # Errors
/// [`RunError::Counterfactual`] if one of the runs fails.
pub fn add_counterfactuals(
    is_cancelled: &(dyn Fn() -> bool + Sync),
    name: &str,
    scenario: &Scenario,
    report: &mut Report,
) -> Result<(), RunError> {
    let other = |counterfactual: &Counterfactual| {
        let unfinished =
            |reason| RunError::Counterfactual { name: counterfactual.stated.name.clone(), reason: Box::new(reason) };
        run_unless(is_cancelled, name, &counterfactual.scenario, Vec::new()).map_err(unfinished)
    };
    let runs =
        scenario.counterfactuals.par_iter().with_max_len(1).map(other).collect::<Result<Vec<Report>, RunError>>()?;
    report.judge_counterfactuals(scenario, runs);
    Ok(())
}

fn finished(is_cancelled: &(dyn Fn() -> bool + Sync), mut simulation: Simulation) -> Result<Report, RunError> {
    while simulation.step()?.is_some() {
        if is_cancelled() {
            return Err(RunError::Cancelled);
        }
    }
    simulation.finish()
}
