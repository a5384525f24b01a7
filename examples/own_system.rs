//! A system of one's own between two phases of the loop, with state that snapshots copy.
//! `cargo run --release --example own_system`

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use bevy_ecs::prelude::*;
use interplay_scenarios::load;
use interplay_simulation::Simulation;
use interplay_simulation::components::{Clock, CurrentTraffic};
use interplay_simulation::phases::{Phase, Slot};

/// Energy that the vehicles' brakes have taken, per mass \[J/kg\].
#[derive(Resource, Clone, Debug, Default, PartialEq)]
struct BrakedEnergy(f64);

/// Adds the work of this tick's decelerations: `−a v dt` where `a` is negative.
fn add_braking(traffic: Res<CurrentTraffic>, clock: Res<Clock>, mut braked: ResMut<BrakedEnergy>) {
    for user in &traffic.0.road_users {
        braked.0 += (-user.agent.previous_input.acceleration_mps2).max(0.0) * user.agent.state.speed_mps * clock.step_s;
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenario = load("intersection/nice", &[])?;
    let mut world = Simulation::builder(&scenario)
        .with_state(BrakedEnergy::default(), BrakedEnergy::clone)
        .with_system(Slot::After(Phase::Act), add_braking)
        .build()?;
    world.advance_to(2.0)?;

    // A copy has the state, too, and goes on as the world that was copied.
    let mut copy = world.snapshot()?.resume()?;
    for world in [&mut world, &mut copy] {
        world.advance_to(scenario.duration_s)?;
    }
    assert_eq!(world.state::<BrakedEnergy>(), copy.state::<BrakedEnergy>());
    let braked = world.state::<BrakedEnergy>().map_or(0.0, |braked| braked.0);
    println!("{}: brakes took {braked:.3} J/kg", scenario.title);
    Ok(())
}
