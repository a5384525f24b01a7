//! What every planner makes of every family of scenarios, and how long a plan takes it.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example outcomes -- [WORD ...]
//! ```
//!
//! prints a row for each run whose name (`family/styles/planner`) holds one of the words, all without any: where the ego ends
//! up and when, its speeds, how near it comes to another in half axes of its safety ellipse, plans that were not found,
//! and the median and 90th percentile of the ego's planning times in milliseconds. A cooperative ego cooperates with the
//! first of the others, whatever its style.

#[path = "../tests/common/world.rs"]
mod world;

use std::io::Write;

use interplay_planners::Driver;
use interplay_planners::drivers::game;
use world::{LANES, Run, STEP_S, egos, families, run};

/// How many ticks a family is driven, and what counts as its outcome.
fn observed(family: &str) -> (usize, fn(&Run) -> String) {
    match family.split('/').next() {
        Some("lane-change") => (100, merged),
        Some("ramp-merge") => (80, merged),
        Some("lane-keeping") => (70, kept),
        _ => (70, crossed),
    }
}

/// The planner with what the recommended settings say about a family.
fn tuned(ego: Driver, family: &str) -> Driver {
    let (accident, slack_weight) = if family.starts_with("intersection") { (1.0, 50.0) } else { (2.0, 0.5) };
    match ego {
        Driver::Game(settings) => Driver::Game(game::Settings { accident, slack_weight, ..settings }),
        other => other,
    }
}

fn merged(run: &Run) -> String {
    run.merged().map_or("never merges".to_owned(), |(place, time_s)| {
        format!("{} at {time_s:.1} s", ["ahead", "between", "behind"][place.min(2)])
    })
}

fn crossed(run: &Run) -> String {
    let time = |tick: Option<usize>| tick.map_or(f64::INFINITY, |tick| STEP_S * tick as f64);
    let (ego, other) = (time(run.first(0, |at| at.x_m > 0.0)), time(run.first(1, |at| at.y_m > LANES[0])));
    format!("{} at {ego:.1} s, other {other:.1} s", if ego < other { "first" } else { "second" })
}

fn kept(run: &Run) -> String {
    let merged = run.first(1, |at| at.y_m > 0.45);
    let ahead = run.order_at(merged.unwrap_or(run.states.len() - 1)).first() == Some(&"ego");
    let time = merged.map_or("never".to_owned(), |tick| format!("at {:.1} s", STEP_S * tick as f64));
    format!("{}, other merges {time}", if ahead { "ahead" } else { "behind" })
}

fn main() -> std::io::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let mut out = std::io::stdout();
    writeln!(
        out,
        "| run | outcome | speed m/s | nearest | not found | median ms | p90 ms |\n|---|---|---|---|---|---|---|"
    )?;
    for (name, pose) in families() {
        let (ticks, outcome) = observed(&name);
        for driver in egos().map(|ego| tuned(ego, &name)) {
            let full = format!("{name}/{}", driver.kind());
            if !words.is_empty() && !words.iter().any(|word| full.contains(word)) {
                continue;
            }
            let mut vehicles = pose(driver.clone());
            if let Driver::Cooperative(_) = driver {
                // It takes two.
                vehicles[1].drive(driver);
            }
            let run = run(vehicles, ticks);
            let speeds = || run.states.iter().map(|states| states[0].speed_mps);
            let (slowest, fastest) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max));
            let collision = if run.collision.is_some() { "collision, " } else { "" };
            writeln!(
                out,
                "| {full} | {collision}{} | {slowest:.2} to {fastest:.2} | {:.2} | {} | {:.3} | {:.3} |",
                outcome(&run),
                run.nearest,
                run.failures.len(),
                run.plan_time_ms(0.5),
                run.plan_time_ms(0.9),
            )?;
        }
    }
    Ok(())
}
