//! One run: a scenario in, a report out.

use interplay_scenarios::{Counterfactual, Scenario};
use rayon::prelude::*;

use crate::phases::watch::Watcher;
use crate::report::Report;
use crate::simulation::Simulation;

pub use crate::simulation::run_error::RunError;

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
