//! What every planner makes of every family of scenarios, and how long a plan takes it.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example outcomes -- [WORD ...]
//! ```
//!
//! prints a row for each run whose name (`family/styles/planner`) holds one of the words, all without any: where the ego ends
//! up and when, its speeds, how near it comes to another in half axes of its safety ellipse, plans that were not found,
//! and the median and 90th percentile of the ego's planning times in milliseconds.

#[path = "../tests/common/world.rs"]
mod world;

use std::io::Write;

use interplay_planners::human::Style::{self, Nice, Tough};
use interplay_planners::{Driver, bayesian, conservative, cooperative, game, negotiation};
use world::{LANES, Run, STEP_S, Vehicle, intersection, lane_change, lane_keeping, ramp_merge, run};

/// A family with its drivers: name, vehicles for an ego's driver, ticks, and what counts as the outcome.
struct Family {
    name: String,
    pose: Box<dyn Fn(Driver) -> Vec<Vehicle>>,
    ticks: usize,
    outcome: fn(&Run) -> String,
}

fn family(
    name: &str,
    ticks: usize,
    outcome: fn(&Run) -> String,
    pose: impl Fn(Driver) -> Vec<Vehicle> + 'static,
) -> Family {
    Family { name: name.to_owned(), pose: Box::new(pose), ticks, outcome }
}

fn families() -> Vec<Family> {
    let pairs: [(&str, [Style; 2]); 3] =
        [("nice-nice", [Nice, Nice]), ("tough-nice", [Tough, Nice]), ("tough-tough", [Tough, Tough])];
    let mut found = Vec::new();
    for (styles, pair) in pairs {
        found.push(family(&format!("lane-change/{styles}"), 100, merged, move |ego| lane_change(ego, pair)));
        found.push(family(&format!("ramp-merge/{styles}"), 80, merged, move |ego| ramp_merge(ego, pair)));
    }
    for (style, one, away_m) in [("nice", Nice, 1.9), ("tough", Tough, 1.75)] {
        found.push(family(&format!("lane-keeping/{style}"), 70, kept, move |ego| lane_keeping(ego, one)));
        let pose = move |ego| intersection(ego, one, away_m);
        found.push(family(&format!("intersection/{style}"), 70, crossed, pose));
    }
    found
}

/// The planners, with what the recommended settings say about a family.
fn planners(family: &str) -> Vec<Driver> {
    let crossing = family.starts_with("intersection");
    let (accident, slack_weight) = if crossing { (1.0, 50.0) } else { (2.0, 0.5) };
    vec![
        Driver::Conservative(conservative::Settings::default()),
        Driver::Negotiation(negotiation::Settings::default()),
        Driver::Bayesian(bayesian::Settings::default()),
        Driver::Game(game::Settings { accident, slack_weight, ..game::Settings::default() }),
        Driver::Cooperative(cooperative::Settings::default()),
    ]
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
    for Family { name, pose, ticks, outcome } in families() {
        for driver in planners(&name) {
            let full = format!("{name}/{}", driver.kind());
            if !words.is_empty() && !words.iter().any(|word| full.contains(word)) {
                continue;
            }
            let run = run(pose(driver), ticks);
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
