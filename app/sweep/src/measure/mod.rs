//! Turns the report of a run into a row.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use interplay_scenarios::{Scenario, SweepPoint};
use interplay_simulation::report::Report;
use interplay_simulation::run::{RunError, run};
use interplay_simulation::watch::Watcher;
use interplay_tables::{TableFile, TrajectoryWriter};

use crate::column::{EgoRun, building_values};
use crate::error::SweepError;
use crate::key::{RunKey, program_version};
use crate::row::{RunResult, SweepRow};

/// Makes a run and its row. If the run fails or panics, the row contains the reason.
///
/// # Errors
/// If the file of trajectories cannot be written.
pub(crate) fn measured_run(
    key: RunKey,
    point: &SweepPoint,
    scenario: &Scenario,
    trajectories: Option<&TableFile>,
) -> Result<SweepRow, SweepError> {
    let writer = trajectories.filter(|_| !scenario.vehicles.is_empty()).map(TrajectoryWriter::begin).transpose()?;
    let watchers = writer.into_iter().map(|writer| Box::new(writer) as Box<dyn Watcher>).collect();
    let began = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| run(&point.scenario, scenario, watchers)));
    let wall_s = began.elapsed().as_secs_f64();
    let outcome = match outcome {
        Ok(Err(RunError::Watch(reason))) => return Err(SweepError::Recording(reason.to_string())),
        Ok(outcome) => outcome.map_err(|error| error.to_string()),
        Err(panic) => Err(format!("panic: {}", message(&*panic))),
    };
    let ego = |report: &Report| report.vehicles.get(scenario.ego_index()).map(|ego| ego.plans);
    let plans = outcome.as_ref().ok().and_then(ego);
    Ok(SweepRow {
        key,
        version: program_version(),
        scenario: point.scenario.clone(),
        family: point.family.clone(),
        style: point.style.clone(),
        planner: point.planner.clone(),
        sample: point.sample,
        seed: point.seed,
        inputs: point.inputs.iter().cloned().collect(),
        error: outcome.as_ref().err().cloned(),
        result: outcome.ok().map(|report| result(scenario, &report)),
        wall_s,
        plan_median_ms: plans.map(|plans| plans.median_ms),
        plan_p99_ms: plans.map(|plans| plans.p99_ms),
    })
}

fn message(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a message")
}

fn result(scenario: &Scenario, report: &Report) -> RunResult {
    let ego = report.vehicles.get(scenario.ego_index());
    RunResult {
        digest: report.digest.clone(),
        simulated_s: report.simulated_s,
        passed: report.passed,
        traffic: ego.map(|ego| EgoRun { scenario, report, ego }.values().collect()),
        building: report.building.as_ref().map(|building| building_values(building).collect()),
    }
}

#[cfg(test)]
mod tests;
