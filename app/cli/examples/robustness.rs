//! How far the outcome of a scenario depends on its exact starts, and what it depends on besides.
//!
//! ```sh
//! cargo run --release -p interplay --example robustness -- [NAME|FILE...] [--starts 200] [--first-seed 1] \
//!     [--set PATH=VALUE]... [--arm 'PATH=VALUE[; PATH=VALUE]...']... > table.md
//! ```
//!
//! Every scenario runs once with every seed 1, 2, …: each vehicle starts up to 0.1 m further ahead or behind on its road, and
//! up to 0.1 m/s faster or slower, drawn from the seed; on real roads up to 1 m and 0.32 m/s (Froude's law). From the same starts run the scenario's counterfactuals (the
//! conservative planner, the planner's mechanism off, another driver's style), so outcomes are compared in pairs; with `--arm`, changes
//! given on the command line run in their place. Without names, the scenarios with a figure in chapters 6 to 8 and all ramp
//! merges run.
//!
//! The outcome of a run is the place of the ego in the order, or on a network of lanes among those whose ways it crosses, and whether anybody touches anybody. A place nearer to the front
//! without contact is better: going first where that is possible is no failure.

#![allow(clippy::print_stdout, reason = "the table is the result")]

use std::error::Error;

use clap::Parser;
use interplay_scenarios::{LoadError, Override, Scenario, embedded, load};
use interplay_simulation::report::Report;
use interplay_simulation::run::{RunError, run};
use rayon::prelude::*;
use thiserror::Error;

/// Perturbs the starts of scenarios and prints what their outcomes depend on, as a Markdown table.
#[derive(Parser)]
struct Study {
    /// Scenarios [default: those with a figure, and ramp merges]
    names: Vec<String>,
    /// How many starts
    #[arg(long, default_value_t = 200)]
    starts: u64,
    /// Seed of the first start; the next starts have the seeds after it
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
    /// Changes of every scenario, as for `interplay run`
    #[arg(long = "set", value_name = "PATH=VALUE")]
    changes: Vec<String>,
    /// A change to compare with, in place of the scenario's counterfactuals; may be repeated
    #[arg(long = "arm", value_name = "PATH=VALUE[; PATH=VALUE]...")]
    arms: Vec<String>,
}

/// The largest change of position \[m\] and of speed \[m/s\] at 1/10 scale.
const JITTER: f64 = 0.1;
/// Times of completion that differ by less count as equal: less than a tick \[s\].
const MIN_DELAY_S: f64 = 0.05;
/// The quantile of the normal distribution that bounds 95 % on both sides.
const NORMAL_QUANTILE_95: f64 = 1.959_963_984_540_054;

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

/// What became of one run.
#[derive(Clone, Copy)]
struct Outcome {
    /// Whether the order is the one that the scenario expects.
    as_expected: bool,
    /// The place of the ego in the order, from 1; large where it has none.
    place: usize,
    touched: bool,
    gap_m: f64,
    completed_s: Option<f64>,
    failed_plans: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut study = Study::parse();
    if study.names.is_empty() {
        study.names = figures_and_ramps()?;
    }
    println!(
        "| scenario | what is changed | order as in the figure, 95 % interval | ego nearer to the front / further back | p | \
         ego done sooner / later, median difference s | p | touched | smallest gap m | ego done s | failed plans |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for name in &study.names {
        for row in study.rows(name)? {
            println!("{row}");
        }
    }
    Ok(())
}

/// The driving scenarios that reproduce a figure, and all ramp merges.
fn figures_and_ramps() -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = Vec::new();
    for file in embedded() {
        let scenario = load(file.name, &[])?;
        if !scenario.vehicles.is_empty() && (scenario.figure.is_some() || file.name.starts_with("ramp-merge/")) {
            names.push(file.name.to_owned());
        }
    }
    Ok(names)
}

impl Study {
    /// A row for the scenario and one for each of its counterfactuals.
    fn rows(&self, name: &str) -> Result<Vec<String>, Box<dyn Error>> {
        let runs: Result<Vec<Vec<Outcome>>, StudyError> =
            (0..self.starts).into_par_iter().map(|start| self.outcomes(name, self.first_seed + start)).collect();
        let runs = runs?;
        let scenario = load(name, &[])?;
        let stated = scenario.counterfactuals.iter().map(|counterfactual| counterfactual.name.as_str());
        let changes: Vec<&str> =
            if self.arms.is_empty() { stated.collect() } else { self.arms.iter().map(String::as_str).collect() };
        let titles = std::iter::once("nothing").chain(changes);
        let arm = |index: usize| runs.iter().map(|run| run[index]).collect::<Vec<Outcome>>();
        let own = arm(0);
        Ok(titles.enumerate().map(|(index, title)| row(name, title, &own, &arm(index))).collect())
    }

    /// The outcomes of one start: the scenario's own, then those of its counterfactuals or of the arms.
    fn outcomes(&self, name: &str, seed: u64) -> Result<Vec<Outcome>, StudyError> {
        let scenario = self.scenario(name, seed, "")?;
        let arms: Result<Vec<Scenario>, LoadError> =
            self.arms.iter().map(|arm| self.scenario(name, seed, arm)).collect();
        let arms = arms?;
        let all = std::iter::once(&scenario).chain(&scenario.changed).chain(&arms);
        all.map(|changed| Ok(Outcome::of(&scenario, &run(name, changed, Vec::new())?))).collect()
    }

    /// The scenario with perturbed starts and the changes of an arm; without its counterfactuals where there are arms.
    fn scenario(&self, name: &str, seed: u64, arm: &str) -> Result<Scenario, LoadError> {
        let only_arms = (!self.arms.is_empty()).then_some("counterfactual=[]");
        let of_arm = arm.split(';').map(str::trim).filter(|change| !change.is_empty());
        let lengths = load(name, &[])?.vehicles.first().map_or(1.0, |vehicle| vehicle.body.scale);
        let jitter = [
            format!("start_jitter.position_m={}", JITTER * lengths),
            format!("start_jitter.speed_mps={}", JITTER * lengths.sqrt()),
        ];
        let changes = jitter
            .iter()
            .map(String::as_str)
            .chain(only_arms)
            .chain(self.changes.iter().map(String::as_str))
            .chain(of_arm);
        let mut overrides: Vec<Override> = changes.map(|change| Override::Set(change.to_owned())).collect();
        overrides.push(Override::Seed(seed));
        load(name, &overrides)
    }
}

impl Outcome {
    fn of(scenario: &Scenario, report: &Report) -> Outcome {
        let is_order = |what: &str| what == "order" || what.starts_with("yields.");
        let judged = report.judged_by(&scenario.expect);
        let name = &scenario.vehicles[scenario.ego_index()].name;
        let ego = &report.vehicles[scenario.ego_index()];
        let failed_plans = report.vehicles.iter().map(|vehicle| vehicle.plans.failed).sum();
        Outcome {
            as_expected: judged
                .iter()
                .filter(|expectation| is_order(&expectation.what))
                .all(|expectation| expectation.passed),
            place: match scenario.network {
                Some(_) => 1 + report.right_of_way.iter().filter(|passage| passage.second == *name).count(),
                None => report.order.iter().position(|found| found == name).map_or(usize::MAX, |index| index + 1),
            },
            touched: !report.collisions.is_empty(),
            gap_m: report.min_gap_m.unwrap_or(f64::INFINITY),
            completed_s: ego.completed_s,
            failed_plans,
        }
    }

    /// Whether the ego does better than in another run from the same start.
    fn is_better_than(&self, other: &Outcome) -> bool {
        (self.touched, self.place) < (other.touched, other.place)
    }
}

/// One line of the table: an arm beside the scenario's own runs.
fn row(name: &str, title: &str, own: &[Outcome], arm: &[Outcome]) -> String {
    let (runs, kept) = (arm.len() as f64, arm.iter().filter(|outcome| outcome.as_expected && !outcome.touched).count());
    let [low, high] = wilson_interval(kept as f64, runs);
    let pairs = || arm.iter().zip(own);
    let nearer = pairs().filter(|(arm, own)| arm.is_better_than(own)).count();
    let further = pairs().filter(|(arm, own)| own.is_better_than(arm)).count();
    let p = sign_test(nearer, further);
    let delays_s: Vec<f64> = pairs().filter_map(|(arm, own)| Some(arm.completed_s? - own.completed_s?)).collect();
    let sooner = delays_s.iter().filter(|delay_s| **delay_s < -MIN_DELAY_S).count();
    let later = delays_s.iter().filter(|delay_s| **delay_s > MIN_DELAY_S).count();
    let (delay, p_time) = (median(delays_s), sign_test(sooner, later));
    let comparison = if title == "nothing" {
        "- | - | - | -".to_owned()
    } else {
        format!("{nearer} / {further} | {p:.1e} | {sooner} / {later}, {delay} | {p_time:.1e}")
    };
    let touched = arm.iter().filter(|outcome| outcome.touched).count();
    let gap_m = arm.iter().map(|outcome| outcome.gap_m).fold(f64::INFINITY, f64::min);
    let failed: usize = arm.iter().map(|outcome| outcome.failed_plans).sum();
    let done = span(arm.iter().filter_map(|outcome| outcome.completed_s));
    format!(
        "| {name} | {title} | {:.0} % ({:.0} to {:.0}) | {comparison} | {touched} | {gap_m:.3} | {done} | {failed} |",
        100.0 * kept as f64 / runs,
        100.0 * low,
        100.0 * high
    )
}

/// Wilson's interval of a share at 95 %.
fn wilson_interval(kept: f64, of: f64) -> [f64; 2] {
    let (share, z) = (kept / of, NORMAL_QUANTILE_95);
    let centre = (share + z * z / (2.0 * of)) / (1.0 + z * z / of);
    let half = z / (1.0 + z * z / of) * (share * (1.0 - share) / of + z * z / (4.0 * of * of)).sqrt();
    [(centre - half).max(0.0), (centre + half).min(1.0)]
}

/// The probability, if nearer and further back were equally likely, of a split of the unequal pairs at least as uneven
/// (McNemar's exact test).
fn sign_test(nearer: usize, further: usize) -> f64 {
    let (of, least) = (nearer + further, nearer.min(further));
    let mut probability = 0.5_f64.powi(of as i32);
    let mut sum = 0.0;
    for count in 0..=least {
        sum += probability;
        probability *= (of - count) as f64 / (count + 1) as f64;
    }
    (2.0 * sum).min(1.0)
}

/// The median with its sign; a dash if there are no values.
fn median(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    let upper = values.len() / 2;
    let lower = values.len().saturating_sub(1) / 2;
    values.get(lower).zip(values.get(upper)).map_or("-".to_owned(), |(a, b)| format!("{:+.1}", 0.5 * (a + b)))
}

/// The range of some times; a dash if there are none.
fn span(values: impl Iterator<Item = f64>) -> String {
    let values: Vec<f64> = values.collect();
    let (least, most) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(*value), most.max(*value)));
    if values.is_empty() { "-".to_owned() } else { format!("{least:.1} to {most:.1}") }
}
