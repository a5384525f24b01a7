//! Perturbed starts of a family of scenarios.

use interplay_planners::prediction::constant_velocity;

use super::SplitMix64;
use super::world::{HORIZON, STEP_S, Vehicle};

/// Largest perturbation along the road \[m\] and of the speed \[m/s\].
const PERTURBATION: f64 = 0.1;

/// The vehicles, each up to 0.1 m further ahead or behind and up to 0.1 m/s faster or slower, by a seed.
pub fn perturbed(mut vehicles: Vec<Vehicle>, seed: u64) -> Vec<Vehicle> {
    let mut random = SplitMix64::new(seed);
    for vehicle in &mut vehicles {
        let state = &mut vehicle.agent.state;
        let along_m = random.uniform(-PERTURBATION, PERTURBATION);
        state.x_m += along_m * libm::cos(state.heading_rad);
        state.y_m += along_m * libm::sin(state.heading_rad);
        state.speed_mps += random.uniform(-PERTURBATION, PERTURBATION);
        vehicle.agent.prediction = constant_velocity(&vehicle.agent.state, HORIZON, STEP_S).into();
    }
    vehicles
}

/// Moves vehicles by up to 0.3 m along their headings, and changes their speeds by up to 0.1 m/s, by a seed.
pub fn perturb(vehicles: &mut [Vehicle], seed: u64) {
    let mut random = SplitMix64::new(1000 + seed);
    for vehicle in vehicles {
        let (sin, cos) = vehicle.agent.state.heading_rad.sin_cos();
        let along = random.uniform(-0.3, 0.3);
        vehicle.agent.state.x_m += along * cos;
        vehicle.agent.state.y_m += along * sin;
        vehicle.agent.state.speed_mps += random.uniform(-0.1, 0.1);
    }
}
