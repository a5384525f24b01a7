//! Sense: components become plain values, in the scenario's order.

use bevy::ecs::prelude::*;
use interplay_planners::{Agent, Trajectory};

use crate::components::{Agents, Clock, Identity, Motion, Physique, Present, Wish};
use crate::frame::{Frame, VehicleFrame};

/// Fills [`Agents`] and opens the tick's [`Frame`].
pub fn sense(
    vehicles: Query<(&Identity, &Motion, &Physique, &Wish)>,
    clock: Res<Clock>,
    mut agents: ResMut<Agents>,
    mut present: ResMut<Present>,
) {
    let mut sorted: Vec<_> = vehicles.iter().collect();
    sorted.sort_by_key(|(identity, ..)| identity.index);
    agents.0 = sorted
        .iter()
        .map(|(identity, motion, physique, wish)| Agent {
            name: identity.name.clone(),
            state: motion.state,
            previous_input: motion.input,
            body: physique.body,
            limits: physique.limits,
            corridor: physique.corridor,
            prediction: Trajectory::default(),
            shared_goal: wish.shared,
        })
        .collect();
    let frames = sorted.iter().map(|(identity, motion, ..)| VehicleFrame {
        name: identity.name.clone(),
        state: motion.state,
        ..VehicleFrame::default()
    });
    present.0 = Frame { tick: clock.tick, time_s: clock.time_s(), vehicles: frames.collect(), ..Frame::default() };
}
