//! Decisions a second of an environment with meta-actions, from Rust alone: a profiler sees the world without Python.
//!
//!     cargo run --release -p interplay-simulation --example environment_steps -- FILE.toml SECONDS
//!
//! The agent keeps its lane and speed, and a decision lasts a second.

#![allow(clippy::print_stdout, reason = "the numbers are the result")]

use std::time::Instant;

use interplay_simulation::environment::{Action, Environment, EnvironmentSettings};

const IDLE: f32 = 1.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("which scenario?")?;
    let seconds: f64 = arguments.next().map_or(Ok(5.0), |text| text.parse())?;
    let scenario = interplay_scenarios::load(&file, &[])?;
    let settings =
        EnvironmentSettings { action: Action::DiscreteMeta, decision_s: Some(1.0), ..EnvironmentSettings::default() };
    let mut environment = Environment::new(&scenario, &settings)?;
    let (mut decisions, mut episodes, mut resetting_s) = (0_u64, 0_u64, 0.0);
    let began = Instant::now();
    while began.elapsed().as_secs_f64() < seconds {
        let resets = Instant::now();
        environment.reset((episodes == 0).then_some(0))?;
        resetting_s += resets.elapsed().as_secs_f64();
        episodes += 1;
        while environment.is_live() {
            environment.step(&[IDLE])?;
            decisions += 1;
        }
    }
    let passed = began.elapsed().as_secs_f64();
    println!(
        "{:.1} decisions a second, {:.1} of an episode, {:.3} ms a reset",
        decisions as f64 / passed,
        decisions as f64 / episodes as f64,
        1e3 * resetting_s / episodes as f64
    );
    Ok(())
}
