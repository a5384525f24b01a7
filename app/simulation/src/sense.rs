//! Sense: components become plain values, in the scenario's order.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use interplay_planners::traffic::{RoadUser, Traffic};
use interplay_planners::{Agent, Trajectory};

use crate::components::{
    Clock, Committed, CurrentFrame, Driving, Identity, Motion, Sensed, VehicleGoal, VehicleParameters,
};
use crate::frame::{Frame, VehicleFrame};

/// Fills [`Sensed`] and opens the tick's [`Frame`].
pub fn sense(
    vehicles: Query<(&Identity, &Motion, &VehicleParameters, &VehicleGoal, &Driving, &Committed)>,
    clock: Res<Clock>,
    mut sensed: ResMut<Sensed>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let mut sorted: Vec<_> = vehicles.iter().collect();
    sorted.sort_by_key(|(identity, ..)| identity.index);
    let road_users = sorted.iter().map(|(identity, motion, parameters, objective, driving, committed)| RoadUser {
        agent: Agent {
            name: identity.name.clone(),
            state: motion.state,
            previous_input: motion.input,
            body: parameters.body,
            limits: parameters.limits,
            route: Arc::clone(&parameters.route),
            prediction: Trajectory::default(),
            shared_goal: objective.shared,
            can_be_asked: driving.can_be_asked,
        },
        goal: objective.goal,
        goes_first: driving.goes_first,
        knows_plans: driving.knows_plans,
        is_crashed: motion.crashed,
        committed: committed.0.clone(),
    });
    let road_users = road_users.collect();
    sensed.0 = Traffic { tick: clock.tick, step_s: clock.step_s, horizon: clock.horizon, road_users };
    let frames = sorted.iter().map(|(identity, motion, ..)| VehicleFrame {
        name: identity.name.clone(),
        state: motion.state,
        ..VehicleFrame::default()
    });
    current_frame.0 =
        Frame { tick: clock.tick, time_s: clock.time_s(), vehicles: frames.collect(), ..Frame::default() };
}
