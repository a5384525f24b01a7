//! How often a search from random starts finds a cheaper plan than a planner did.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example multistart -- [WORD ...]
//! cargo run --release -p interplay-planners --example multistart -- recorded [DRAW]
//! ```
//!
//! The first drives every family of scenarios from perturbed starts with every planner, in closed loop. Every few steps the
//! problem that a driver poses is solved from 30 random starts besides. A row for each family and driver says in how many of
//! its problems the cheapest of them costs less than the plan by more than a thousandth (of 1 + cost), and how long the plans
//! took.
//!
//! The second does the same with the recorded problems (`tests/data`): the plan is a descent from the recorded warm start and a
//! comparison of the homotopy classes, finished at once, or a global search. A row for each planner counts the problems with a
//! cheaper random start, and gives their share with its 95 % interval (Wilson's score interval). Then each such problem follows
//! with both costs. `DRAW` seeds the random starts.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/common/recorded.rs"]
mod recorded;

use std::collections::BTreeMap;
use std::error::Error;
use std::io::Write;
use std::time::Instant;

use common::SplitMix64;
use common::wilson_interval;
use common::world::{Vehicle, begin, egos, families};
use interplay_planners::plan::diagnostic::COST;
use interplay_planners::trajectory::{HomotopySearch, Optimiser, Problem, Robust};
use interplay_planners::{Driver, Input, Plan};
use recorded::Recorded;

const STARTS: u64 = 30;
const SEEDS: u64 = 4;
/// By how much the cheapest of the random starts must be cheaper, as a share of 1 + cost, to count.
const CHEAPER: f64 = 1e-3;
/// Every how many ticks the problems are searched.
const CHECKED_EVERY: u64 = 4;
const TICKS: u64 = 50;

#[derive(Default)]
struct Tally {
    problems: usize,
    beaten: Vec<(f64, String)>,
    plan_ms: Vec<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.as_slice() {
        [first] if first == "recorded" => search_recorded(0),
        [first, draw] if first == "recorded" => search_recorded(draw.parse()?),
        _ => Ok(search_closed_loop(&words)?),
    }
}

/// What random starts find in the problems of a set.
#[derive(Default)]
struct Findings {
    problems: usize,
    beaten: Vec<String>,
}

impl Findings {
    /// Notes the costs of a problem's plan and of the cheapest optimum that random starts found.
    fn note(&mut self, id: &str, planned: f64, found: f64) {
        self.problems += 1;
        let gain = (planned - found) / (1.0 + planned.abs());
        if gain > CHEAPER || planned == f64::INFINITY {
            self.beaten.push(format!("{id}: plan {planned:.5}, random start {found:.5}"));
        }
    }

    /// Cells of a table: problems, those with a cheaper random start, their share and its 95 % interval.
    fn row(&self) -> String {
        let (count, of) = (self.beaten.len(), self.problems);
        let [low, high] = wilson_interval(count, of).map(|share| 100.0 * share);
        format!("{of} | {count} | {:.2} % | {low:.2} % to {high:.2} %", 100.0 * count as f64 / of as f64)
    }
}

/// How far planners look for a cheaper plan, in the order of the columns.
const SEARCHES: [HomotopySearch; 2] = [HomotopySearch::Classes, HomotopySearch::Global];

/// Prints how often random starts find something cheaper in the recorded problems.
fn search_recorded(draw: u64) -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout();
    let mut sums: [(&str, [Findings; 2]); 2] =
        ["ramps and intersections", "all"].map(|name| (name, Default::default()));
    let mut beaten = Vec::new();
    let columns = "problems | cheaper random start | share | 95 % interval";
    writeln!(out, "| planner | classes: {columns} | global: {columns} |\n|---|{}", "---|".repeat(8))?;
    for kind in recorded::KINDS {
        let mut own: [Findings; 2] = Default::default();
        for (index, recorded) in recorded::load(kind)?.iter().enumerate() {
            let found = cheapest(&recorded.problem(), (draw << 32) + index as u64);
            let is_elsewhere = ["ramp", "crossing"].iter().any(|place| recorded.id.starts_with(place));
            for (column, search) in SEARCHES.into_iter().enumerate() {
                let planned = planned_cost(kind, search, recorded);
                own[column].note(&recorded.id, planned, found);
                for (_, sum) in sums.iter_mut().skip(usize::from(!is_elsewhere)) {
                    sum[column].note(&recorded.id, planned, found);
                }
            }
        }
        writeln!(out, "| {kind} | {} | {} |", own[0].row(), own[1].row())?;
        out.flush()?;
        let lines = SEARCHES.iter().zip(own);
        beaten.extend(lines.flat_map(|(search, findings)| {
            findings.beaten.into_iter().map(move |text| format!("{search:?}: {kind} {text}"))
        }));
    }
    sums.iter()
        .try_for_each(|(name, [classes, global])| writeln!(out, "| {name} | {} | {} |", classes.row(), global.row()))?;
    beaten.iter().try_for_each(|text| writeln!(out, "{text}"))?;
    Ok(())
}

/// What a planner's descent and search come to; infinite if they fail.
fn planned_cost(kind: &str, search: HomotopySearch, recorded: &Recorded) -> f64 {
    let mut optimiser = recorded::optimiser(kind).searching(search);
    optimiser.warm_start = recorded.memory();
    let plan = optimiser.optimise(&recorded.problem(), &recorded.guess());
    plan.map_or(f64::INFINITY, |plan| plan.cost.total)
}

/// Prints how often random starts find something cheaper in closed loop.
fn search_closed_loop(words: &[String]) -> std::io::Result<()> {
    let mut out = std::io::stdout();
    let mut tallies: BTreeMap<String, Tally> = BTreeMap::new();
    for (family, pose) in families() {
        for ego in egos() {
            let name = format!("{family}/{}", ego.kind());
            if !words.is_empty() && !words.iter().all(|word| name.contains(word)) {
                continue;
            }
            for seed in 0..SEEDS {
                let mut vehicles = pose(ego.clone());
                common::starts::perturb(&mut vehicles, seed);
                if let Driver::Cooperative(_) = ego {
                    vehicles[1].drive(ego.clone());
                }
                drive(&name, seed, &vehicles, &mut tallies);
            }
        }
    }
    let mut total: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for (name, mut tally) in tallies {
        let Tally { problems, beaten, plan_ms } = &mut tally;
        plan_ms.sort_by(f64::total_cmp);
        let at = |share: f64| plan_ms[((plan_ms.len() - 1) as f64 * share) as usize];
        beaten.sort_by(|a, b| b.0.total_cmp(&a.0));
        let worst: Vec<String> = beaten.iter().take(3).map(|(gain, id)| format!("{gain:.3} {id}")).collect();
        let (count, of) = (beaten.len(), *problems);
        let (low, mid, most) = (at(0.5), at(0.99), at(1.0));
        writeln!(out, "| {name} | {count} of {of} | {low:.3} | {mid:.3} | {most:.3} | {} |", worst.join("; "))?;
        let kind = name.rsplit('/').next().unwrap_or_default().to_owned();
        let entry = total.entry(kind).or_default();
        *entry = (entry.0 + count, entry.1 + of);
    }
    writeln!(out, "{total:?}")
}

fn drive(name: &str, seed: u64, vehicles: &[Vehicle], tallies: &mut BTreeMap<String, Tally>) {
    let (mut traffic, mut planners) = begin(vehicles);
    for tick in 0..TICKS {
        traffic.drive(|index, scene| {
            let began = Instant::now();
            let plan = planners[index].plan(scene)?;
            let took = 1e3 * began.elapsed().as_secs_f64();
            let kind = vehicles[index].driver.kind();
            let family = name.rsplit_once('/').map_or(name, |(family, _)| family);
            let tally = tallies.entry(format!("{family}/{kind}")).or_default();
            tally.plan_ms.push(took);
            if let Some(problem) =
                plan.problem.as_deref().filter(|_| (index == 0 || kind != "cooperative") && tick % CHECKED_EVERY == 0)
            {
                tally.problems += 1;
                let cost = cost_of(problem, &plan);
                let found = cheapest(problem, seed * 1000 + tick);
                let gain = (cost - found) / (1.0 + cost.abs());
                if gain > CHEAPER {
                    let text = format!("{name}/{seed}/{tick}/{} {cost:.4} {found:.4}", scene.ego.name);
                    tally.beaten.push((gain, text));
                }
            }
            Ok(plan)
        });
    }
}

/// What a plan with its proposal costs in the problem that it solves.
fn cost_of(problem: &Problem, plan: &Plan) -> f64 {
    plan.value_of(&COST).unwrap_or_else(|| problem.cost_of(std::slice::from_ref(&plan.trajectory.inputs)))
}

fn cheapest(problem: &Problem, seed: u64) -> f64 {
    let mut random = SplitMix64::new(seed);
    let mut best = f64::INFINITY;
    for _ in 0..STARTS {
        let guess: Vec<Vec<Input>> = problem.participants.iter().map(|_| random_inputs(&mut random)).collect();
        if let Ok(optimum) = Optimiser::receding_horizon(Robust::default()).descend(problem, &guess) {
            best = best.min(optimum.cost.total);
        }
    }
    best
}

/// Five pieces of random acceleration and steering.
fn random_inputs(random: &mut SplitMix64) -> Vec<Input> {
    let pieces: Vec<Input> = (0..5)
        .map(|_| Input { acceleration_mps2: random.uniform(-1.2, 1.2), steering_rad: random.uniform(-0.4, 0.4) })
        .collect();
    (0..30).map(|t| pieces[t / 6]).collect()
}
