//! Dependence of a run's outcome on single factors: compares the scenario's own run with runs that each change one.

use interplay_scenarios::{Scenario, StandardChange};
use rayon::prelude::*;
use serde::Serialize;

use crate::report::Report;
use crate::simulation::Simulation;
use crate::simulation::Snapshot;
use crate::simulation::run_error::RunError;

/// Smallest reported change of a completion time \[s\].
const NOTICEABLE_S: f64 = 0.3;

/// The scenario's own run and the changed ones; its serialisation is the output of `interplay why --json`.
#[derive(Clone, Debug, Serialize)]
pub struct WhyReport {
    /// Name of the scenario.
    pub scenario: String,
    /// The seed of all runs, unless a change concerns it.
    pub seed: u64,
    /// Time from which the changes hold; none if they hold from the beginning \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_s: Option<f64>,
    /// Factors with at least one change that gives another order.
    pub order_depends_on: Vec<String>,
    /// Factors without a change that gives another order.
    pub order_does_not_depend_on: Vec<String>,
    /// Factors with at least one change that makes an expectation fail; none if the scenario's own run does not pass.
    pub expectations_depend_on: Vec<String>,
    /// Factors that do not affect the order, but shift a vehicle's completion by at least 0.3 s, or prevent it.
    pub times_depend_on: Vec<String>,
    /// The scenario's own run, then the changed ones.
    pub runs: Vec<WhyRun>,
}

/// The scenario's own run or a changed one, with its outcome.
#[derive(Clone, Debug, Serialize)]
pub struct WhyRun {
    /// The change in words; `None` for the scenario's own run.
    pub change: Option<String>,
    /// The factor on which the outcome depends if this run differs.
    pub factor: Option<String>,
    /// The change as arguments of `--set`.
    pub set: Vec<String>,
    /// Names from first to last.
    pub order: Vec<String>,
    /// Whether the order differs from that of the scenario's own run.
    pub order_differs: bool,
    /// Completion time of each vehicle.
    pub vehicles: Vec<Arrival>,
    /// Smallest distance of the ego's footprint to another \[m\].
    pub min_gap_m: Option<f64>,
    /// Number of contacts.
    pub collisions: usize,
    /// Plans that failed, over all vehicles.
    pub plan_failures: usize,
    /// Whether the scenario's expectations hold in this run; none if it has no expectations.
    pub expectations_hold: Option<bool>,
    /// The expectations that do not hold.
    pub failed: Vec<String>,
    /// Digest of all states, bit for bit.
    pub digest: String,
}

/// A vehicle with the time at which it reached its goal.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Arrival {
    /// Name of the vehicle.
    pub name: String,
    /// Time at which it reached its goal \[s\]; `None` if it never did.
    pub completed_s: Option<f64>,
}

impl WhyRun {
    /// Obstacles are not listed.
    fn new(report: &Report, main: &Report, change: Option<&StandardChange>) -> WhyRun {
        let order = report.order_of_driven();
        let failed = report.expectations.iter().filter(|one| !one.passed).map(|one| one.what.clone());
        let arrival = |vehicle: &crate::report::VehicleReport| Arrival {
            name: vehicle.name.clone(),
            completed_s: vehicle.completed_s,
        };
        WhyRun {
            change: change.map(|change| change.change.clone()),
            factor: change.map(|change| change.factor.clone()),
            set: change.map(|change| change.sets.clone()).unwrap_or_default(),
            order_differs: order != main.order_of_driven(),
            order: order.into_iter().map(str::to_owned).collect(),
            vehicles: report.vehicles.iter().filter(|vehicle| !vehicle.is_obstacle).map(arrival).collect(),
            min_gap_m: report.min_gap_m(),
            collisions: report.collisions.len(),
            plan_failures: report.vehicles.iter().map(|vehicle| vehicle.plans.failed).sum(),
            expectations_hold: (!report.expectations.is_empty()).then_some(report.passed),
            failed: failed.collect(),
            digest: report.digest.clone(),
        }
    }

    /// Whether a vehicle completes noticeably earlier or later than in another run, or in only one of them.
    fn times_differ(&self, main: &WhyRun) -> bool {
        let mut pairs = self.vehicles.iter().zip(&main.vehicles);
        pairs.any(|(here, there)| match (here.completed_s, there.completed_s) {
            (Some(here), Some(there)) => (here - there).abs() >= NOTICEABLE_S - 1e-9,
            (None, None) => false,
            _ => true,
        })
    }
}

/// Runs a scenario, called `name`, and its changed forms in parallel; `advance` is called after every run.
///
/// The changes hold from the beginning, or from the first tick at or after `at_s` \[s\]: until then all runs equal the scenario's own.
/// Drivers with changed settings then keep their memory; a driver of another kind starts anew.
///
/// # Errors
/// [`RunError`], if one of the runs fails, or the world cannot be copied at `at_s`.
pub fn why(
    name: &str,
    scenario: &Scenario,
    changes: &[StandardChange],
    at_s: Option<f64>,
    advance: &(dyn Fn() + Sync),
) -> Result<WhyReport, RunError> {
    let then = at_s.map(|at_s| moment(name, scenario, at_s)).transpose()?;
    let one = |change: Option<&StandardChange>| {
        let changed = change.map_or(scenario, |change| &change.scenario);
        let mut simulation = match &then {
            Some(then) => then.resume()?,
            None => Simulation::watched(name, changed, Vec::new())?,
        };
        if then.is_some() && change.is_some() {
            simulation.change_drivers(changed);
        }
        while simulation.step()?.is_some() {}
        advance();
        simulation.finish()
    };
    let all: Vec<Option<&StandardChange>> = std::iter::once(None).chain(changes.iter().map(Some)).collect();
    let reports =
        all.par_iter().with_max_len(1).map(|change| one(*change)).collect::<Result<Vec<Report>, RunError>>()?;
    let runs = reports.iter().zip(all).map(|(report, change)| WhyRun::new(report, &reports[0], change)).collect();
    Ok(conclude(name, scenario.seed, then.map(|then| then.time_s()), runs))
}

/// The world of a scenario at the first tick at or after a time.
fn moment(name: &str, scenario: &Scenario, at_s: f64) -> Result<Snapshot, RunError> {
    let mut simulation = Simulation::watched(name, scenario, Vec::new())?;
    while simulation.time_s() < at_s && simulation.step()?.is_some() {}
    Ok(simulation.snapshot()?)
}

/// Sorts the factors by their effect; the first run is the scenario's own.
fn conclude(name: &str, seed: u64, at_s: Option<f64>, runs: Vec<WhyRun>) -> WhyReport {
    let factors = |matters: &dyn Fn(&WhyRun) -> bool| {
        let mut found: Vec<String> = Vec::new();
        for factor in runs.iter().filter(|run| matters(run)).filter_map(|run| run.factor.as_ref()) {
            if !found.contains(factor) {
                found.push(factor.clone());
            }
        }
        found
    };
    let order_depends_on = factors(&|run| run.order_differs);
    let mut others = factors(&|_| true);
    others.retain(|factor| !order_depends_on.contains(factor));
    let passes = runs.first().and_then(|main| main.expectations_hold) == Some(true);
    let mut times = factors(&|run| runs.first().is_some_and(|main| run.times_differ(main)));
    times.retain(|factor| !order_depends_on.contains(factor));
    WhyReport {
        scenario: name.to_owned(),
        seed,
        at_s,
        expectations_depend_on: factors(&|run| passes && run.expectations_hold == Some(false)),
        order_depends_on,
        order_does_not_depend_on: others,
        times_depend_on: times,
        runs,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run_of(factor: Option<&str>, order: &str, completed_s: Option<f64>, holds: bool) -> WhyRun {
        WhyRun {
            change: factor.map(str::to_owned),
            factor: factor.map(str::to_owned),
            set: Vec::new(),
            order: order.split(' ').map(str::to_owned).collect(),
            order_differs: order != "a b",
            vehicles: vec![Arrival { name: "a".to_owned(), completed_s }],
            min_gap_m: None,
            collisions: 0,
            plan_failures: 0,
            expectations_hold: Some(holds),
            failed: Vec::new(),
            digest: String::new(),
        }
    }

    /// A factor matters if any of its changes does, and is listed once.
    #[test]
    fn factors_are_sorted_by_their_effect() {
        let runs = |passes: bool| {
            vec![
                run_of(None, "a b", Some(2.0), passes),
                run_of(Some("style"), "a b", Some(2.1), true),
                run_of(Some("style"), "b a", Some(2.1), false),
                run_of(Some("filter"), "a b", Some(2.3), true),
                run_of(Some("belief"), "a b", None, false),
                run_of(Some("gamma"), "a b", Some(1.9), true),
            ]
        };
        let report = conclude("x", 1, None, runs(true));
        assert_eq!(report.order_depends_on, ["style"]);
        assert_eq!(report.order_does_not_depend_on, ["filter", "belief", "gamma"]);
        assert_eq!(report.times_depend_on, ["filter", "belief"]);
        assert_eq!(report.expectations_depend_on, ["style", "belief"]);
        let failed = conclude("x", 1, None, runs(false));
        assert!(failed.expectations_depend_on.is_empty(), "a run that fails anyway has no dependence");
    }
}
