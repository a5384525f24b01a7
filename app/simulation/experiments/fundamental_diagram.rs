//! Capacity of a lane as a function of speed: a row of cars follows a leader at constant speed until all have settled.
//!
//! ```sh
//! cargo run --release -p interplay-simulation --example fundamental_diagram
//! ```
//!
//! The closed form of the intelligent driver model is listed beside it: in equilibrium the gap is `(s₀ + v T) / √(1 − (v/v₀)^δ)`.

#![allow(clippy::print_stdout, reason = "the numbers are the result")]

use std::error::Error;
use std::sync::{Arc, Mutex, PoisonError};

use interplay_planners::Driver;
use interplay_scenarios::{Scenario, from_text};
use interplay_simulation::frame::Frame;
use interplay_simulation::run::run;
use interplay_simulation::watch::{WatchError, Watcher};

const FOLLOWERS: usize = 12;
/// Desired speed of all cars but the first \[m/s\].
const WANTED_MPS: f64 = 30.0;
/// A row that differs more from the leader's speed has not settled \[m/s\].
const MOST_OFF_MPS: f64 = 0.5;
const SPEEDS_MPS: [f64; 6] = [2.0, 5.0, 10.0, 15.0, 20.0, 25.0];
const DRIVERS: [(&str, &str); 4] = [
    ("IDM", "{ kind = \"idm\" }"),
    ("nice", "{ kind = \"human\", style = \"nice\" }"),
    ("normal", "{ kind = \"human\", style = \"normal\" }"),
    ("tough", "{ kind = \"human\", style = \"tough\" }"),
];

/// Keeps the last frame of a run.
#[derive(Clone, Default)]
struct Last(Arc<Mutex<Frame>>);

impl Watcher for Last {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = frame.clone();
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

fn scenario(driver: &str, speed_mps: f64) -> Result<Scenario, Box<dyn Error>> {
    let mut text = format!(
        "title = 'A row of cars'\nshows = 'A row of cars behind a slow one'\nscale = 'full'\nduration_s = 150.0\nstep_s = 0.1\n\
         planning_period_s = 0.2\nbudget = {{ plans = 10000000, steps = 1000000000 }}\n\
         road = {{ kind = 'lanes', lane_count = 1, lane_width_m = 3.5 }}\n\
         defaults = {{ class = 'car', driver = {driver} }}\n\
         [[vehicle]]\nname = 'ego'\ndriver = {{ kind = 'idm' }}\n\
         start = {{ lane = 0, along_m = 0.0, speed_mps = {speed_mps} }}\ngoal = {{ speed_mps = {speed_mps} }}\n"
    );
    for number in 1..=FOLLOWERS {
        let along_m = -(number as f64) * (10.0 + 2.0 * speed_mps);
        text += &format!(
            "[[vehicle]]\nname = 'car-{number}'\nstart = {{ lane = 0, along_m = {along_m}, speed_mps = {speed_mps} }}\n\
             goal = {{ speed_mps = {WANTED_MPS} }}\n"
        );
    }
    Ok(from_text("row.toml", &text, &[])?)
}

/// The distance from front to front in the rear half of the row, and its speed.
fn settled(scenario: &Scenario) -> Result<[f64; 2], Box<dyn Error>> {
    let last = Last::default();
    run("row", scenario, vec![Box::new(last.clone())])?;
    let frame = last.0.lock().unwrap_or_else(PoisonError::into_inner);
    let rear = &frame.vehicles[FOLLOWERS / 2..];
    let pairs = (rear.len() - 1) as f64;
    let spacing_m = rear.windows(2).map(|pair| pair[0].state.x_m - pair[1].state.x_m).sum::<f64>() / pairs;
    Ok([spacing_m, rear.iter().map(|car| car.state.speed_mps).sum::<f64>() / rear.len() as f64])
}

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "| drivers | speed m/s | spacing m | density 1/km | flow 1/h | closed form 1/h |\n|---|---|---|---|---|---|"
    );
    for (name, driver) in DRIVERS {
        for speed_mps in SPEEDS_MPS {
            let scenario = scenario(driver, speed_mps)?;
            let [spacing_m, found_mps] = settled(&scenario)?;
            let follower = &scenario.vehicles[1];
            let closed = match &follower.driver {
                Driver::Idm(idm) => {
                    let free = (speed_mps / WANTED_MPS).powf(idm.exponent);
                    let gap_m = (idm.gap_m + speed_mps * idm.headway_s) / (1.0 - free).sqrt();
                    format!("{:.0}", 3600.0 * speed_mps / (gap_m + follower.body.front_m + follower.body.rear_m))
                }
                _ => String::new(),
            };
            if spacing_m <= 0.0 || (found_mps - speed_mps).abs() > MOST_OFF_MPS {
                println!("| {name} | {speed_mps:.1} | the row broke up | | | {closed} |");
                continue;
            }
            let (density, flow) = (1000.0 / spacing_m, 3600.0 * found_mps / spacing_m);
            println!("| {name} | {found_mps:.1} | {spacing_m:.1} | {density:.1} | {flow:.0} | {closed} |");
        }
    }
    Ok(())
}
