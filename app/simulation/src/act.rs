//! Act: the first input of each plan is applied, within the vehicle's bounds.

use bevy::ecs::prelude::*;

use crate::components::{Clock, Identity, Motion, Physique, Present};

/// Hands the decided inputs to the plant.
pub fn act(mut vehicles: Query<(&Identity, &Physique, &mut Motion)>, clock: Res<Clock>, mut present: ResMut<Present>) {
    for (identity, physique, mut motion) in &mut vehicles {
        let limits = &physique.limits;
        let wanted = present.0.vehicles[identity.index].input;
        let mut input = wanted;
        // A speed must stay within its bounds whatever a fallback asks for.
        let low = limits.acceleration_min_mps2.max((limits.speed_min_mps - motion.state.speed_mps) / clock.step_s);
        let high = limits.acceleration_max_mps2.min((limits.speed_max_mps - motion.state.speed_mps) / clock.step_s);
        input.acceleration_mps2 = wanted.acceleration_mps2.max(low).min(high);
        input.steering_rad = wanted.steering_rad.clamp(-limits.steering_max_rad, limits.steering_max_rad);
        present.0.vehicles[identity.index].input = input;
        motion.input = input;
    }
}
