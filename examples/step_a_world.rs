//! Steps a world from outside: looks at what a driver is given, decides for it, goes back to a moment, and decides otherwise.
//! `cargo run --release --example step_a_world`

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use interplay_planners::{Input, Scene};
use interplay_scenarios::{Override, load};
use interplay_simulation::Simulation;

/// How many ticks the ego hesitates in the second world.
const HESITATION_TICKS: usize = 25;

/// Holds the wanted speed, or slows down for the vehicle ahead in the lane.
fn decide(scene: &Scene) -> Input {
    let ego = &scene.ego;
    let leads_m = scene.others.iter().filter(|other| ego.shares_lane_with(other)).map(|other| ego.lead_of(other));
    let lead_m = leads_m.filter(|lead_m| *lead_m > 0.0).fold(f64::INFINITY, f64::min);
    let wanted_mps = scene.goal.target.speed_mps.min(0.5 * lead_m);
    Input { acceleration_mps2: (wanted_mps - ego.state.speed_mps) / scene.step_s, steering_rad: 0.0 }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let external = Override::Set("vehicle.ego.driver={ kind = \"external\" }".to_owned());
    let scenario = load("intersection/nice", &[external])?;
    let mut world = Simulation::new(&scenario)?;
    while world.time_s() < 1.0 {
        let input = decide(&world.observe("ego")?.scene);
        world.apply("ego", input)?;
        world.step()?;
    }

    // Two worlds go on from here. Each has all state: what the humans plan and believe, bodies, noise, measures.
    let fork = world.snapshot()?;
    for (name, brakes_for) in [("drives on", 0), ("hesitates", HESITATION_TICKS)] {
        let mut world = fork.resume()?;
        let mut ticks = 0;
        loop {
            let seen = world.observe("ego")?.scene;
            let braking = Input { acceleration_mps2: seen.ego.limits.acceleration_min_mps2, steering_rad: 0.0 };
            world.apply("ego", if ticks < brakes_for { braking } else { decide(&seen) })?;
            if world.step()?.is_none() {
                break;
            }
            ticks += 1;
        }
        let report = world.finish()?;
        println!("the ego {name}: order {}, smallest gap {:.2?} m", report.order.join(", "), report.min_gap_m());
    }
    Ok(())
}
