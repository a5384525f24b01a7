//! Loads a scenario, changes one of its settings, runs it, and reads what was measured.
//! `cargo run --release --example first_run`

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use interplay_scenarios::{Override, load};
use interplay_simulation::run::run;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The name of an authored scenario, or the path of a file; and changes as after `--set`.
    let scenario = load("lane-change/front-nice", &[Override::Set("vehicle.ego.goal.speed_mps=1.1".to_owned())])?;
    // Watchers are shown every tick as it happens, such as the recorder for Rerun. Here are none.
    let report = run("hurry", &scenario, Vec::new())?;

    for vehicle in &report.vehicles {
        println!(
            "{:6} is driven by {:12} and reached its goal at {:?} s",
            vehicle.name, vehicle.driver, vehicle.completed_s
        );
    }
    println!("order at the end: {}; digest of all states: {}", report.order.join(", "), report.digest);
    for expectation in &report.expectations {
        println!("{} {}: {}", if expectation.passed { "ok  " } else { "FAIL" }, expectation.what, expectation.got);
    }
    Ok(())
}
