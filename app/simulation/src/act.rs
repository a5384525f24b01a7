//! Act: the first input of each plan is applied, within the vehicle's limits.

use bevy_ecs::prelude::*;

use crate::components::{Identity, Motion, Present, Sensed};

/// Hands the decided inputs to the plant.
pub fn act(mut vehicles: Query<(&Identity, &mut Motion)>, sensed: Res<Sensed>, mut present: ResMut<Present>) {
    let inputs = sensed.0.applied_inputs();
    for (identity, mut motion) in &mut vehicles {
        motion.input = inputs[identity.index];
        present.0.vehicles[identity.index].input = inputs[identity.index];
    }
}
