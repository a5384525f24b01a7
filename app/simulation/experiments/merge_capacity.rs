//! How many vehicles pass a merge: a motorway of two lanes that an on-ramp joins, at growing demand.
//!
//! ```sh
//! cargo run --release -p interplay-simulation --example merge_capacity
//! ```
//!
//! The lane's own capacity is the most that the fundamental diagram of its drivers allows (`fundamental_diagram`); what a merge carries
//! beyond a demand is what it has lost to the changes of lane.

#![allow(clippy::print_stdout, reason = "the numbers are the result")]

use std::error::Error;
use std::sync::{Arc, Mutex, PoisonError};

use interplay_scenarios::{Scenario, from_text};
use interplay_simulation::frame::Frame;
use interplay_simulation::run::run;
use interplay_simulation::watch::{WatchError, Watcher};

/// Vehicles are counted here, as a coordinate of the world along the motorway, behind the merge \[m\].
const COUNTED_AT_M: f64 = 440.0;
/// The road fills for so long before anybody is counted \[s\].
const FILLS_S: f64 = 90.0;
/// Vehicles are counted for so long \[s\].
const COUNTED_S: f64 = 180.0;
/// Vehicles an hour on each of two lanes, and on the ramp \[1/h\].
const DEMANDS_PER_H: [[f64; 2]; 6] =
    [[500.0, 200.0], [900.0, 300.0], [1200.0, 400.0], [1500.0, 500.0], [1800.0, 600.0], [2100.0, 700.0]];
const DRIVERS: [(&str, &str); 3] = [
    ("IDM", "{ kind = \"idm\" }"),
    ("nice", "{ kind = \"human\", style = \"nice\" }"),
    ("normal", "{ kind = \"human\", style = \"normal\" }"),
];

/// What was counted behind the merge.
#[derive(Clone, Copy, Debug, Default)]
struct Counted {
    passed: usize,
    /// Sum of speeds \[m/s\].
    speeds_mps: f64,
    /// Vehicles whose time has come, and for whom there was no room at the end.
    outside: usize,
}

/// Counts who passes the line.
#[derive(Clone, Default)]
struct Line {
    counted: Arc<Mutex<Counted>>,
    last_m: Vec<Option<f64>>,
    enters_s: Vec<f64>,
}

impl Watcher for Line {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        let mut counted = self.counted.lock().unwrap_or_else(PoisonError::into_inner);
        let now = frame.vehicles.iter().map(|vehicle| (!vehicle.is_absent).then_some(vehicle.state.x_m));
        let now: Vec<_> = now.collect();
        for (index, (before, after)) in self.last_m.iter().zip(&now).enumerate() {
            let passes = matches!((before, after), (Some(a), Some(b)) if *a < COUNTED_AT_M && *b >= COUNTED_AT_M);
            if passes && frame.time_s >= FILLS_S {
                counted.passed += 1;
                counted.speeds_mps += frame.vehicles[index].state.speed_mps;
            }
        }
        let seen = |index: usize| self.last_m.get(index).is_some_and(Option::is_some);
        let due = self
            .enters_s
            .iter_mut()
            .enumerate()
            .filter(|(index, at_s)| **at_s <= frame.time_s && now[*index].is_none() && !seen(*index));
        counted.outside = due.count();
        for (index, at_s) in self.enters_s.iter_mut().enumerate() {
            // Whoever has come waits no more.
            if now[index].is_some() {
                *at_s = f64::INFINITY;
            }
        }
        self.last_m = now;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
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
            let scenario = scenario(driver, demand)?;
            let enters_s = scenario.vehicles.iter().map(|vehicle| vehicle.stay.enters_s.unwrap_or(0.0)).collect();
            let line = Line { enters_s, ..Line::default() };
            let report = run("merge", &scenario, vec![Box::new(line.clone())])?;
            let counted = *line.counted.lock().unwrap_or_else(PoisonError::into_inner);
            let behind_per_h = 3600.0 * counted.passed as f64 / COUNTED_S;
            let mean_mps = counted.speeds_mps / counted.passed.max(1) as f64;
            let ([lane, ramp], contacts) = (demand, report.collisions.len());
            let outside = counted.outside;
            println!("| {name} | {lane} | {ramp} | {behind_per_h:.0} | {mean_mps:.1} | {outside} | {contacts} |");
        }
    }
    Ok(())
}
