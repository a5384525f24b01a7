//! Predict: a vehicle that has planned before is expected to go on with its plan, any other at constant velocity.

use bevy::ecs::prelude::*;
use interplay_planners::Trajectory;
use interplay_planners::predict::constant_velocity;

use crate::components::{Agents, Clock, Identity, Intention, Present};

/// Fills the predictions of [`Agents`]. Drivers who plan first replace theirs by what they decide.
pub fn predict(
    vehicles: Query<(&Identity, &Intention)>,
    clock: Res<Clock>,
    mut agents: ResMut<Agents>,
    mut present: ResMut<Present>,
) {
    for (identity, intention) in &vehicles {
        let agent = &mut agents.0[identity.index];
        agent.prediction = match &intention.plan {
            Some(plan) => anchored(plan.shifted(), agent.state),
            None => constant_velocity(&agent.state, clock.horizon, clock.step_s),
        };
        present.0.vehicles[identity.index].prediction = agent.prediction.clone();
    }
}

/// The same motion from where the vehicle really is: a plant need not follow the plan exactly.
fn anchored(mut plan: Trajectory, state: interplay_planners::State) -> Trajectory {
    if let Some(first) = plan.states.first_mut() {
        *first = state;
    }
    plan
}
