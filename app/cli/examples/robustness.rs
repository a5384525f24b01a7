//! How far the outcome of a scenario depends on its exact starts, and what its planner gains over the conservative one.
//!
//! ```sh
//! cargo run --release -p interplay --example robustness -- [NAME...] [--seeds 50] [--set PATH=VALUE]... > table.md
//! ```
//!
//! Every scenario runs once with every seed 1, 2, …: each vehicle starts up to 0.1 m further ahead or behind on its road, and
//! up to 0.1 m/s faster or slower, drawn from the seed. The scenario's planner and the conservative one meet the same
//! starts, so their outcomes are compared in pairs. An outcome is kept if the order is the one that the scenario expects,
//! nobody has touched anybody, and whoever is expected to complete its task has done so, at whatever time. Without names, the
//! scenarios with a figure in chapters 6 to 8 run.

#![allow(clippy::print_stdout, reason = "the table is the result")]

use std::error::Error;

use clap::Parser;
use interplay_scenarios::{LoadError, Override, Scenario, embedded, load};
use interplay_simulation::report::Report;
use interplay_simulation::run::{RunError, run};
use rayon::prelude::*;
use thiserror::Error;

/// Perturbs the starts of scenarios and prints which outcomes are kept, as a Markdown table.
#[derive(Parser)]
struct Study {
    /// Scenarios [default: those with a figure]
    names: Vec<String>,
    /// How many starts
    #[arg(long, default_value_t = 50)]
    seeds: u64,
    /// Changes of every scenario, as for `interplay run`
    #[arg(long = "set", value_name = "PATH=VALUE")]
    changes: Vec<String>,
    /// Whom the scenario's planner is compared with
    #[arg(long, default_value = "conservative")]
    rival: String,
}

/// The largest changes of position and speed.
const JITTER: [&str; 2] = ["start_jitter.position_m=0.1", "start_jitter.speed_mps=0.1"];

/// Why a start has no outcome.
#[derive(Debug, Error)]
enum StudyError {
    /// The scenario, or a change of it, is refused.
    #[error(transparent)]
    Scenario(#[from] LoadError),
    /// The run failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// What became of one start.
struct Outcome {
    kept: bool,
    touched: bool,
    gap_m: f64,
    completed_s: Option<f64>,
    speed_mps: [f64; 2],
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut study = Study::parse();
    if study.names.is_empty() {
        study.names = with_a_figure()?;
    }
    println!(
        "| scenario | planner | kept | rival kept | won | lost | touched | smallest gap m | completed s | speed m/s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for name in &study.names {
        println!("{}", study.row(name)?);
    }
    Ok(())
}

/// The driving scenarios that reproduce a figure.
fn with_a_figure() -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = Vec::new();
    for file in embedded() {
        let scenario = load(file.name, &[])?;
        if scenario.figure.is_some() && !scenario.vehicles.is_empty() {
            names.push(file.name.to_owned());
        }
    }
    Ok(names)
}

impl Study {
    /// One line of the table.
    fn row(&self, name: &str) -> Result<String, Box<dyn Error>> {
        let planner = load(name, &self.overrides(1, None))?.ego().map_or("", |ego| ego.driver.kind());
        let own = self.outcomes(name, None)?;
        let rival = self.outcomes(name, Some(&self.rival))?;
        let share = |outcomes: &[Outcome]| {
            100.0 * outcomes.iter().filter(|outcome| outcome.kept).count() as f64 / self.seeds as f64
        };
        let pairs = || own.iter().zip(&rival);
        let won = pairs().filter(|(own, rival)| own.kept && !rival.kept).count();
        let lost = pairs().filter(|(own, rival)| !own.kept && rival.kept).count();
        let touched = own.iter().filter(|outcome| outcome.touched).count();
        let gaps = own.iter().map(|outcome| outcome.gap_m).fold(f64::INFINITY, f64::min);
        let rival_gaps = rival.iter().map(|outcome| outcome.gap_m).fold(f64::INFINITY, f64::min);
        let done = span(own.iter().filter_map(|outcome| outcome.completed_s));
        let slowest = span(own.iter().map(|outcome| outcome.speed_mps[0]));
        let fastest = span(own.iter().map(|outcome| outcome.speed_mps[1]));
        Ok(format!(
            "| {name} | {planner} | {:.0} % | {:.0} % | {won} | {lost} | {touched} | {gaps:.3} ({rival_gaps:.3}) | {done} | \
             {slowest}, {fastest} |",
            share(&own),
            share(&rival)
        ))
    }

    /// The outcomes of all seeds in their order, of the scenario's own planner or another.
    fn outcomes(&self, name: &str, planner: Option<&str>) -> Result<Vec<Outcome>, Box<dyn Error>> {
        let outcome = |seed: u64| -> Result<Outcome, StudyError> {
            let scenario = load(name, &self.overrides(seed, planner))?;
            let report = run(name, &scenario, Vec::new())?;
            Ok(Outcome::of(&scenario, &report))
        };
        let outcomes: Result<Vec<Outcome>, StudyError> = (1..=self.seeds).into_par_iter().map(outcome).collect();
        Ok(outcomes?)
    }

    fn overrides(&self, seed: u64, planner: Option<&str>) -> Vec<Override> {
        let changes = JITTER.iter().copied().chain(self.changes.iter().map(String::as_str));
        let mut overrides: Vec<Override> = changes.map(|change| Override::Set(change.to_owned())).collect();
        overrides.push(Override::Seed(seed));
        overrides.extend(planner.map(|kind| Override::Planner(kind.to_owned())));
        overrides
    }
}

impl Outcome {
    fn of(scenario: &Scenario, report: &Report) -> Outcome {
        let expect = &scenario.expect;
        let in_order =
            expect.order.as_ref().is_none_or(|order| report.order.iter().filter(|name| order.contains(name)).eq(order));
        let completed = |name: &str| report.vehicle(name).and_then(|vehicle| vehicle.completed_s);
        let all_done = expect.completes.iter().all(|task| completed(&task.vehicle).is_some());
        let touched = !report.collisions.is_empty();
        let ego = &report.vehicles[scenario.ego_index()];
        Outcome {
            kept: in_order && all_done && !touched,
            touched,
            gap_m: report.min_gap_m.unwrap_or(f64::INFINITY),
            completed_s: ego.completed_s,
            speed_mps: [ego.min_speed_mps, ego.max_speed_mps],
        }
    }
}

/// The smallest and the largest of some numbers, as text.
fn span(numbers: impl Iterator<Item = f64> + Clone) -> String {
    let (low, high) = (numbers.clone().fold(f64::INFINITY, f64::min), numbers.fold(f64::NEG_INFINITY, f64::max));
    if low > high { "-".to_owned() } else { format!("{low:.2}–{high:.2}") }
}
