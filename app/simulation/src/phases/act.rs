//! Act: applies the first input of each plan, within the vehicle's limits, and makes the frame of the tick.

use bevy_ecs::prelude::*;
use interplay_planners::Input;
use interplay_planners::traffic::{RoadUser, applied_input};

use crate::state::components::{Clock, CurrentFrame, CurrentTraffic, Driving, Fleet, SpareFrames};
use crate::state::frame::VehicleFrame;

/// Passes the decided inputs to the plant. With several ticks between plans, inputs change linearly from the last
/// input to that of the plan, which they reach in the last of these ticks. Recorded vehicles take their inputs from the record in every
/// tick.
pub fn act(clock: Res<Clock>, mut traffic: ResMut<CurrentTraffic>) {
    let ticks_left = clock.ticks_per_plan - clock.ticks_since_plan();
    for user in traffic.0.road_users.iter_mut().filter(|user| !user.is_absent()) {
        let planned = user.planned_input();
        let RoadUser { agent, record, .. } = user;
        let (body, limits, last) = (&agent.body, &agent.limits, agent.previous_input);
        let times_s = [clock.time_s(), clock.step_s];
        let recorded = record.as_ref().and_then(|record| record.input(body, limits, &agent.state, times_s));
        let wanted = recorded.unwrap_or_else(|| towards(&last, planned, ticks_left));
        let mut applied = applied_input(&wanted, &agent.state, body, limits, clock.step_s);
        // At the start of the run, wheels stand as the driver wants.
        if clock.tick > 0 {
            applied.steering_rad = limits.steering_towards_rad(last.steering_rad, applied.steering_rad, clock.step_s);
        }
        agent.previous_input = applied;
    }
}

/// The next of `ticks_left` inputs that change linearly from one to another.
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

/// Writes every vehicle into the frame, for watchers and measures: its state before it moves, and its decision.
pub fn describe(
    vehicles: Query<&Driving>,
    fleet: Res<Fleet>,
    traffic: Res<CurrentTraffic>,
    (mut current_frame, mut spare): (ResMut<CurrentFrame>, ResMut<SpareFrames>),
) {
    let frame = &mut current_frame.0;
    std::mem::swap(&mut frame.vehicles, &mut spare.0);
    frame.vehicles.resize_with(fleet.0.len(), VehicleFrame::default);
    for (row, (entity, vehicle)) in fleet.0.iter().zip(&mut frame.vehicles).enumerate() {
        let plan_ms = vehicles.get(*entity).map_or(0.0, |driving| driving.plan_ms);
        vehicle.become_row(&traffic.0, row, plan_ms);
    }
}
