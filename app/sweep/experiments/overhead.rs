//! The overhead of a sweep: the runs of a plan, made by a sweep and by the library in a loop.
//!
//! ```sh
//! cargo run --release -p interplay-sweep --example overhead -- [PLAN] [SAMPLES] [REPEATS]
//! ```
//!
//! Both make the same runs on one thread, in turn. *Besides its runs* is the share of the sweep's wall time in which no run was
//! active: keys, two checks of every scenario, journal, table. Other programs disturb a sweep and a loop differently, so
//! their ratio is less reliable.

#![allow(clippy::print_stdout, reason = "the numbers are the result")]

use std::error::Error;
use std::fs;
use std::time::Instant;

use interplay_scenarios::SweepPlan;
use interplay_simulation::run::run;
use interplay_sweep::{Shard, SweepOptions, SweepRow, sweep};

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let name = words.next().unwrap_or_else(|| "quick".to_owned());
    let samples = words.next().map(|word| word.parse()).transpose()?;
    let repeats: usize = words.next().map_or(Ok(3), |word| word.parse())?;
    let plan = SweepPlan::load(&name, samples)?;
    println!(
        "| runs | sweep s | of that runs s | besides its runs % | loop s | sweep / loop |\n|---|---|---|---|---|---|"
    );
    for _ in 0..repeats {
        let (sweep_s, runs_s) = by_sweep(&plan)?;
        let loop_s = by_loop(&plan)?;
        println!(
            "| {} | {sweep_s:.2} | {runs_s:.2} | {:.2} | {loop_s:.2} | {:.4} |",
            plan.run_count(),
            100.0 * (1.0 - runs_s / sweep_s),
            sweep_s / loop_s
        );
    }
    Ok(())
}

/// Wall time of a sweep on one thread, and the sum of that of its runs \[s\].
fn by_sweep(plan: &SweepPlan) -> Result<(f64, f64), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let options = SweepOptions {
        folder: folder.path(),
        shard: Shard::WHOLE,
        keep: None,
        trajectories: false,
        checked: &|| {},
        begin: &|_, _| {},
        advance: &|| {},
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let began = Instant::now();
    pool.install(|| sweep(plan, &options))?;
    let sweep_s = began.elapsed().as_secs_f64();
    let journal = fs::read_to_string(folder.path().join("journal.jsonl"))?;
    let rows = journal.lines().map(serde_json::from_str).collect::<Result<Vec<SweepRow>, _>>()?;
    Ok((sweep_s, rows.iter().map(|row| row.wall_s).sum()))
}

/// Wall time of the same runs in a loop \[s\].
fn by_loop(plan: &SweepPlan) -> Result<f64, Box<dyn Error>> {
    let began = Instant::now();
    for index in 0..plan.run_count() {
        let point = plan.point(index);
        let scenario = plan.scenario(&point)?;
        run(&point.scenario, &scenario, Vec::new())?;
    }
    Ok(began.elapsed().as_secs_f64())
}
