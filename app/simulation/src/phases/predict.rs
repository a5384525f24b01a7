//! Predict: what everybody is expected to do.

use bevy_ecs::prelude::*;

use crate::state::components::Sensed;

/// Fills the predictions of [`Sensed`].
pub fn predict(mut sensed: ResMut<Sensed>) {
    sensed.0.predict();
}
