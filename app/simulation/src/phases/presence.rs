//! Vehicles enter and leave the road at the times that the scenario states, or leave at the ends of their routes.

use bevy_ecs::prelude::*;
use interplay_planners::drivers::recorded::next_to;
use interplay_planners::traffic::{Presence, RoadUser, Traffic};
use interplay_planners::{Agent, State};

use crate::state::components::{Clock, CurrentFrame, CurrentTraffic};
use crate::state::frame::{Event, Level};

/// Times that differ by less are equal \[s\].
const TIME_TOLERANCE_S: f64 = 1e-9;
/// A vehicle leaves this far before the end of its route, in lengths of its body.
const END_LENGTHS: f64 = 0.5;

/// Adds vehicles that are due and have room, and removes others. Runs in ticks in which vehicles plan.
pub fn come_and_go(clock: Res<Clock>, mut traffic: ResMut<CurrentTraffic>, mut current_frame: ResMut<CurrentFrame>) {
    let traffic = &mut traffic.0;
    for row in 0..traffic.road_users.len() {
        if traffic.road_users[row].stay.is_permanent() {
            continue;
        }
        let (before, now) = (traffic.road_users[row].presence, presence_now(traffic, row, clock.time_s()));
        if now == before {
            continue;
        }
        let RoadUser { agent, presence, record, .. } = &mut traffic.road_users[row];
        *presence = now;
        let text = if now == Presence::Present { "comes" } else { "leaves" };
        if before.is_absent() != now.is_absent() {
            current_frame.0.events.push(Event {
                vehicle: agent.name.clone(),
                level: Level::Note,
                text: text.to_owned(),
            });
        }
        if let Some(state) = record.as_ref().and_then(|record| record.state_at(clock.time_s())) {
            // A recorded vehicle enters at the present position of its record.
            agent.state = State { heading_rad: next_to(state.heading_rad, agent.state.heading_rad), ..state };
        }
    }
}

/// The presence of a vehicle from this time on \[s\].
fn presence_now(traffic: &Traffic, row: usize, time_s: f64) -> Presence {
    let RoadUser { agent, presence, stay, record, .. } = &traffic.road_users[row];
    let is_due = |at_s: Option<f64>| at_s.is_some_and(|at_s| time_s + TIME_TOLERANCE_S >= at_s);
    match presence {
        Presence::Present if is_due(stay.leaves_s) || (stay.leaves_at_end && is_at_end(agent)) => Presence::Left,
        Presence::Awaited if is_due(stay.leaves_s) => Presence::Left,
        Presence::Awaited if is_due(stay.enters_s) && (record.is_some() || traffic.has_room_for(row)) => {
            Presence::Present
        }
        same => *same,
    }
}

/// Whether a vehicle has reached the end of its route.
fn is_at_end(Agent { state, body, route, .. }: &Agent) -> bool {
    route.is_in_network() && route.along(state.position()) + END_LENGTHS * (body.front_m + body.rear_m) >= route.end_m()
}
