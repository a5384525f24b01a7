//! Capacity of a merge: an on-ramp joins a motorway of two lanes, at growing demand.
//!
//! ```sh
//! cargo run --release -p interplay-simulation --example merge_capacity
//! ```
//!
//! The capacity of a lane without a merge is the maximum of the fundamental diagram of its drivers (`fundamental_diagram`); the
//! difference is lost to lane changes.

#![allow(clippy::print_stdout, reason = "the numbers are the result")]

use std::error::Error;

use interplay_scenarios::{Scenario, from_text};
use interplay_simulation::Simulation;

/// World coordinate along the motorway at which vehicles are counted, behind the merge \[m\].
const COUNTED_AT_M: f64 = 440.0;
/// Time for which the road fills before the count begins \[s\].
const FILLS_S: f64 = 90.0;
/// Duration of the count \[s\].
const COUNTED_S: f64 = 180.0;
/// Vehicles an hour on each of two lanes, and on the ramp \[1/h\].
const DEMANDS_PER_H: [[f64; 2]; 6] =
    [[500.0, 200.0], [900.0, 300.0], [1200.0, 400.0], [1500.0, 500.0], [1800.0, 600.0], [2100.0, 700.0]];
const DRIVERS: [(&str, &str); 3] = [
    ("IDM", "{ kind = \"idm\" }"),
    ("nice", "{ kind = \"human\", style = \"nice\" }"),
    ("normal", "{ kind = \"human\", style = \"normal\" }"),
];

#[derive(Debug, Default)]
struct Counted {
    passed: usize,
    speeds_mps: f64,
    /// Vehicles that were due and had no room to enter by the end.
    outside: usize,
    contacts: usize,
}

/// Counts the vehicles that pass the line in a run.
fn counted(scenario: &Scenario) -> Result<Counted, Box<dyn Error>> {
    let mut simulation = Simulation::new(scenario)?;
    let mut found = Counted::default();
    let mut last_m = vec![None; scenario.vehicles.len()];
    let mut has_come = vec![false; scenario.vehicles.len()];
    while let Some(frame) = simulation.step()? {
        for (index, vehicle) in frame.vehicles.iter().enumerate().filter(|(_, vehicle)| !vehicle.is_absent) {
            let now_m = vehicle.state.x_m;
            let passes = last_m[index].is_some_and(|last_m| last_m < COUNTED_AT_M) && now_m >= COUNTED_AT_M;
            if passes && frame.time_s >= FILLS_S {
                found.passed += 1;
                found.speeds_mps += vehicle.state.speed_mps;
            }
            (last_m[index], has_come[index]) = (Some(now_m), true);
        }
        let is_due = |index: &usize| scenario.vehicles[*index].stay.enters_s.unwrap_or(0.0) <= frame.time_s;
        found.outside = (0..has_come.len()).filter(|index| !has_come[*index] && is_due(index)).count();
        found.contacts += frame.collisions.len();
    }
    Ok(found)
}

fn scenario(driver: &str, [lane_per_h, ramp_per_h]: [f64; 2]) -> Result<Scenario, Box<dyn Error>> {
    let text = format!(
        "title = 'A merge'\nshows = 'A merge'\nduration_s = {}\nstep_s = 0.1\nplanning_period_s = 0.2\n\
         budget = {{ plans = 10000000, steps = 1000000000 }}\nroad = {{ kind = 'on-ramp' }}\n\
         defaults = {{ class = 'car', driver = {driver} }}\n\
         [[flow]]\nname = 'main'\nvehicles_per_h = {}\nfrom = ['main-0', 'main-1']\nalong_m = 5.0\n\
         speed_mps = 25.0\nspeed_sd_mps = 1.2\n\
         [[flow]]\nname = 'ramp'\nvehicles_per_h = {ramp_per_h}\nfrom = ['ramp']\nalong_m = 5.0\nspeed_mps = 22.0\n\
         to = [{{ lane = 'main-0', share = 1.0 }}]\n",
        FILLS_S + COUNTED_S,
        2.0 * lane_per_h
    );
    Ok(from_text("merge.toml", &text, &[])?)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("| drivers | a lane 1/h | ramp 1/h | behind 1/h | mean speed m/s | wait outside | contacts |");
    println!("|---|---|---|---|---|---|---|");
    for (name, driver) in DRIVERS {
        for demand in DEMANDS_PER_H {
            let Counted { passed, speeds_mps, outside, contacts } = counted(&scenario(driver, demand)?)?;
            let behind_per_h = 3600.0 * passed as f64 / COUNTED_S;
            let mean_mps = speeds_mps / passed.max(1) as f64;
            let [lane, ramp] = demand;
            println!("| {name} | {lane} | {ramp} | {behind_per_h:.0} | {mean_mps:.1} | {outside} | {contacts} |");
        }
    }
    Ok(())
}
