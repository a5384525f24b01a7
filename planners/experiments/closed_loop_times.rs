//! How long an ego's plans take in closed loop, and where they lead, from perturbed starts of every family of scenarios.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example closed_loop_times -- PLANNER [STARTS [SEED]]
//! ```
//!
//! Each vehicle starts up to 0.1 m further ahead or behind and up to 0.1 m/s faster or slower. A start is driven twice, with the
//! same plans, and the shorter time of each plan counts, so that other load on the machine shows less. *Place* counts the runs in
//! which the ego has 0, 1, 2 others ahead of it when it has merged or crossed, at the end otherwise.

#[path = "../tests/common/mod.rs"]
mod common;

use std::error::Error;
use std::io::Write;

use common::starts::perturbed;
use common::world::{LANES, Run, Vehicle, egos, families, run};
use interplay_planners::Driver;

const TICKS: usize = 80;
/// How often each start is driven.
const REPEATS: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let planner = words.first().ok_or("usage: closed_loop_times PLANNER [STARTS [SEED]]")?;
    let starts: u64 = words.get(1).map_or(Ok(20), |word| word.parse())?;
    let first_seed: u64 = words.get(2).map_or(Ok(1), |word| word.parse())?;
    let driver = egos().into_iter().find(|ego| ego.kind() == planner).ok_or("no such planner")?;
    let mut out = std::io::stdout();
    writeln!(out, "| family | place 0, 1, 2 | not merged | contacts | not found | median ms | p99 ms | max ms |")?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    let mut all = Vec::new();
    for (name, pose) in families() {
        let (mut places, mut times_ms) = ([0; 3], Vec::new());
        let (mut stuck, mut contacts, mut failures) = (0, 0, 0);
        for seed in first_seed..first_seed + starts {
            let (run, mut shortest_ms) = drive(&driver, &pose, seed);
            places[place(&run, &name)] += 1;
            stuck += usize::from(merges(&name) && run.merged().is_none());
            contacts += usize::from(run.collision.is_some());
            failures += run.failures.len();
            times_ms.append(&mut shortest_ms);
        }
        let [a, b, c] = places;
        writeln!(out, "| {name} | {a}, {b}, {c} | {stuck} | {contacts} | {failures} | {} |", quantiles(&mut times_ms))?;
        all.append(&mut times_ms);
    }
    writeln!(out, "| all | | | | | {} |", quantiles(&mut all))?;
    Ok(())
}

/// A run from a perturbed start, and the shortest time of each of the ego's plans \[ms\].
fn drive(driver: &Driver, pose: &dyn Fn(Driver) -> Vec<Vehicle>, seed: u64) -> (Run, Vec<f64>) {
    let start = || perturbed(pose(driver.clone()), seed);
    let mut driven = run(start(), TICKS);
    for _ in 1..REPEATS {
        let again = run(start(), TICKS);
        driven.plan_ms.iter_mut().zip(again.plan_ms).for_each(|(shortest, ms)| *shortest = shortest.min(ms));
    }
    let times_ms = std::mem::take(&mut driven.plan_ms);
    (driven, times_ms)
}

/// How many others are ahead of the ego.
fn place(run: &Run, family: &str) -> usize {
    if family.starts_with("intersection") {
        let (ego, other) = (run.first(0, |at| at.x_m > 0.0), run.first(1, |at| at.y_m > LANES[0]));
        return usize::from(other.is_some_and(|other| ego.is_none_or(|ego| other < ego)));
    }
    let last = run.states.len() - 1;
    let merged = run.merged().filter(|_| merges(family)).map(|(place, _)| place);
    merged.or_else(|| run.order_at(last).iter().position(|name| *name == "ego")).unwrap_or(2)
}

/// Whether the ego is to merge.
fn merges(family: &str) -> bool {
    family.starts_with("lane-change") || family.starts_with("ramp-merge")
}

/// Median, 99th percentile and largest of times.
fn quantiles(times_ms: &mut [f64]) -> String {
    times_ms.sort_by(f64::total_cmp);
    let at = |share: f64| times_ms.get(((times_ms.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(f64::NAN);
    format!("{:.2} | {:.2} | {:.2}", at(0.5), at(0.99), at(1.0))
}
