//! How long an ego takes to infer the plans of the others, per tick and observed vehicle, in closed loop from perturbed starts.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example inference_times -- [STARTS [SEED]]
//! ```
//!
//! A negotiating ego that knows no plans meets the humans of every family. In each tick its observations are given to a second,
//! equal belief, which is timed. A start is driven twice, with the same beliefs, and the shorter time of each tick counts, so that other
//! load on the machine shows less. *First* is the tick in which the others are first seen: nothing has been planned for them yet.

#[path = "../tests/common/mod.rs"]
mod common;

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use common::starts::perturbed;
use common::world::{Vehicle, begin, families};
use interplay_planners::Driver;
use interplay_planners::drivers::negotiation;
use interplay_planners::perception::belief::{DriverBeliefs, Settings};
use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::prediction::Prediction;

const TICKS: usize = 80;
/// How often each start is driven.
const REPEATS: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let starts: u64 = words.first().map_or(Ok(10), |word| word.parse())?;
    let first_seed: u64 = words.get(1).map_or(Ok(1), |word| word.parse())?;
    let prediction = Prediction::Inferred;
    let ego = Driver::Negotiation(negotiation::Settings { prediction, ..negotiation::Settings::default() });
    let mut out = std::io::stdout();
    writeln!(out, "| family | median ms | mean ms | p99 ms | max ms | first, median ms |\n|---|---|---|---|---|---|")?;
    let (mut all, mut all_first) = (Vec::new(), Vec::new());
    for (family, pose) in families() {
        let (mut times_ms, mut first_ms) = (Vec::new(), Vec::new());
        for seed in first_seed..first_seed + starts {
            let mut ticks_ms = infer(&perturbed(pose(ego.clone()), seed));
            for _ in 1..REPEATS {
                let again = infer(&perturbed(pose(ego.clone()), seed));
                ticks_ms.iter_mut().zip(again).for_each(|(shortest, ms)| *shortest = shortest.min(ms));
            }
            first_ms.push(ticks_ms.remove(0));
            times_ms.append(&mut ticks_ms);
        }
        writeln!(out, "| {family} | {} |", row(&mut times_ms, &mut first_ms))?;
        all.append(&mut times_ms);
        all_first.append(&mut first_ms);
    }
    writeln!(out, "| all | {} |", row(&mut all, &mut all_first))?;
    Ok(())
}

/// The time of each tick, per observed vehicle \[ms\].
fn infer(vehicles: &[Vehicle]) -> Vec<f64> {
    let (mut traffic, mut planners) = begin(vehicles);
    let mut timed = DriverBeliefs::new(Settings::default());
    let mut times_ms = Vec::new();
    for _ in 0..TICKS {
        traffic.drive(|index, scene| {
            if index == 0 {
                let sensed = SensedScene::perfect(scene);
                let began = Instant::now();
                timed.infer(&sensed);
                times_ms.push(1e3 * began.elapsed().as_secs_f64() / scene.others.len().max(1) as f64);
            }
            planners[index].plan(scene)
        });
    }
    times_ms
}

/// Median, mean, 99th percentile and largest of times, and the median of those of first ticks.
fn row(times_ms: &mut [f64], first_ms: &mut [f64]) -> String {
    times_ms.sort_by(f64::total_cmp);
    first_ms.sort_by(f64::total_cmp);
    let at = |times: &[f64], share: f64| times[((times.len() - 1) as f64 * share) as usize];
    let mean = times_ms.iter().sum::<f64>() / times_ms.len() as f64;
    let [median, p99, largest] = [0.5, 0.99, 1.0].map(|share| at(times_ms, share));
    format!("{median:.2} | {mean:.2} | {p99:.1} | {largest:.1} | {:.1}", at(first_ms, 0.5))
}
