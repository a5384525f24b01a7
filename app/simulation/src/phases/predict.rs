//! Predict: the expected motion of every vehicle.

use bevy_ecs::prelude::*;

use crate::state::components::CurrentTraffic;

/// Fills the predictions of [`CurrentTraffic`].
pub fn predict(mut traffic: ResMut<CurrentTraffic>) {
    traffic.0.predict();
}
