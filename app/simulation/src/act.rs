//! Act: the first input of each plan is applied, within the vehicle's limits.

use bevy_ecs::prelude::*;

use crate::components::{CurrentFrame, Identity, Motion, Sensed};

/// Hands the decided inputs to the plant.
pub fn act(
    mut vehicles: Query<(&Identity, &mut Motion)>,
    sensed: Res<Sensed>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let inputs = sensed.0.applied_inputs();
    for (identity, mut motion) in &mut vehicles {
        motion.input = inputs[identity.index];
        current_frame.0.vehicles[identity.index].input = inputs[identity.index];
    }
}
