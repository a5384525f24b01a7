//! Act: the first input of each plan is applied, within the vehicle's limits.

use bevy_ecs::prelude::*;
use interplay_planners::Input;
use interplay_planners::traffic::applied_input;

use crate::state::components::{Clock, CurrentFrame, Identity, Motion, Sensed, VehicleParameters};

/// Hands the decided inputs to the plant. Where there are several ticks from one plan to the next, inputs change evenly from the last
/// one to that of the plan, which they reach with the last of these ticks. Who follows a record has the inputs of that in every tick.
pub fn act(
    mut vehicles: Query<(&Identity, &VehicleParameters, &mut Motion)>,
    clock: Res<Clock>,
    sensed: Res<Sensed>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let ticks_left = clock.ticks_per_plan - clock.ticks_since_plan();
    let frame = &mut current_frame.0;
    for (identity, VehicleParameters { body, limits, record, .. }, mut motion) in &mut vehicles {
        if frame.vehicles[identity.index].is_absent {
            continue;
        }
        let planned = sensed.0.road_users[identity.index].planned_input();
        let times_s = [clock.time_s(), clock.step_s];
        let recorded = record.as_ref().and_then(|record| record.input((body, limits), &motion.state, times_s));
        let wanted = recorded.unwrap_or_else(|| towards(&motion.input, planned, ticks_left));
        let mut applied = applied_input(&wanted, &motion.state, body, limits, clock.step_s);
        // When the run begins, wheels stand as the driver wants.
        if clock.tick > 0 {
            let last_rad = motion.input.steering_rad;
            applied.steering_rad = limits.steering_towards_rad(last_rad, applied.steering_rad, clock.step_s);
        }
        motion.input = applied;
        frame.vehicles[identity.index].input = motion.input;
    }
}

/// The next of so many inputs that change evenly from one to another.
fn towards(last: &Input, planned: Input, ticks_left: usize) -> Input {
    if ticks_left == 1 {
        return planned;
    }
    let next = |last: f64, planned: f64| last + (planned - last) / ticks_left as f64;
    Input {
        acceleration_mps2: next(last.acceleration_mps2, planned.acceleration_mps2),
        steering_rad: next(last.steering_rad, planned.steering_rad),
    }
}
