//! A sweep from code: two planners among two styles of drivers, from the same perturbed starts, and what the runs say.
//! `cargo run --release --example sweep_in_code -- [FOLDER]`

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use std::path::PathBuf;

use interplay_scenarios::SweepPlan;
use interplay_sweep::compare::{GroupBy, compare};
use interplay_sweep::{Shard, SweepOptions, sweep};

/// `docs/guide/sweeps.md` describes plans. All planners get the same starts.
const PLAN: &str = r#"
scenario = ["intersection/nice", "lane-change/front-nice"]
planner = ["conservative", "negotiation"]
style = ["nice", "tough"]
samples = 4
jitter = { position_m = 0.1, speed_mps = 0.1 }
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).map_or_else(|| std::env::temp_dir().join("interplay-sweep"), PathBuf::from);
    let plan = SweepPlan::from_text("two planners", PLAN, &folder)?;
    let options = SweepOptions {
        folder: &folder,
        shard: Shard::WHOLE,
        keep: None,
        trajectories: false,
        checked: &|| (),
        begin: &|to_make, there| println!("{to_make} runs to make, {there} are there"),
        advance: &|| (),
    };
    // A row a run, in a Parquet file; a sweep that was stopped goes on where it was.
    let outcome = sweep(&plan, &options)?;
    println!("{} rows in {}", outcome.rows, outcome.table.display());

    let figures = compare(&folder, Some("conservative"), GroupBy::Family, plan.metrics())?;
    for group in figures.groups.iter().filter(|group| group.family.is_none()) {
        let style = group.style.as_deref().unwrap_or("all");
        for planner in &group.planners {
            let share = |key| {
                planner.figures.share(key).map_or_else(String::new, |share| format!("{}/{}", share.count, share.of))
            };
            println!("{style:6} {:14} success {}, first {}", planner.planner, share("success"), share("first"));
        }
    }
    Ok(())
}
