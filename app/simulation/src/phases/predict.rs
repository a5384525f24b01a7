//! Predict: how every vehicle is expected to move on.

use bevy_ecs::prelude::*;

use crate::state::components::CurrentTraffic;

/// Fills the predictions of [`CurrentTraffic`].
pub fn predict(mut traffic: ResMut<CurrentTraffic>) {
    traffic.0.predict();
}
