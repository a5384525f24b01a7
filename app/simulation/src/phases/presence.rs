//! Who is on the road: vehicles come and leave at the times that the scenario states, or leave where their routes end.

use bevy_ecs::prelude::*;
use interplay_planners::State;
use interplay_planners::drivers::recorded::next_to;
use interplay_scenarios::Stay;

use crate::state::components::{Clock, CurrentFrame, Identity, Motion, Sensed, VehicleParameters};
use crate::state::frame::{Event, Level};

/// Times that differ by less are equal \[s\].
const TIME_TOLERANCE_S: f64 = 1e-9;
/// Somebody leaves this far before the end of its route, in lengths of its body.
const END_LENGTHS: f64 = 0.5;

/// Whether a vehicle is on the road.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Presence {
    /// Not yet.
    Awaited,
    /// It is.
    #[default]
    Present,
    /// Not any more.
    Left,
}

impl Presence {
    /// Whether a vehicle is on the road at the start of a run.
    pub fn at_start(stay: &Stay) -> Presence {
        if stay.enters_s.is_some_and(|enters_s| enters_s > 0.0) { Presence::Awaited } else { Presence::Present }
    }

    /// Whether it is not on the road.
    pub fn is_absent(self) -> bool {
        self != Presence::Present
    }
}

/// Lets vehicles come whose time has come and for whom there is room, and others leave. Runs in ticks in which vehicles plan.
pub fn come_and_go(
    mut vehicles: Query<(&Identity, &mut Motion, &VehicleParameters, &mut Presence)>,
    clock: Res<Clock>,
    mut sensed: ResMut<Sensed>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let (traffic, frame) = (&mut sensed.0, &mut current_frame.0);
    let mut sorted: Vec<_> =
        vehicles.iter_mut().filter(|(_, _, parameters, _)| !parameters.stay.is_permanent()).collect();
    sorted.sort_by_key(|(identity, ..)| identity.index);
    let is_due = |at_s: Option<f64>| at_s.is_some_and(|at_s| clock.time_s() + TIME_TOLERANCE_S >= at_s);
    for (identity, motion, parameters, presence) in &mut sorted {
        let (index, stay) = (identity.index, parameters.stay);
        let now = match **presence {
            Presence::Present if is_due(stay.leaves_s) || (stay.leaves_at_end && is_at_end(motion, parameters)) => {
                Presence::Left
            }
            Presence::Awaited if is_due(stay.leaves_s) => Presence::Left,
            Presence::Awaited if is_due(stay.enters_s) => {
                let is_free = parameters.record.is_some() || traffic.has_room_for(index);
                if is_free { Presence::Present } else { Presence::Awaited }
            }
            same => same,
        };
        if now == **presence {
            continue;
        }
        let text = if now == Presence::Present { "comes" } else { "leaves" };
        if presence.is_absent() != now.is_absent() {
            let vehicle = identity.name.clone();
            frame.events.push(Event { vehicle, level: Level::Note, text: text.to_owned() });
        }
        **presence = now;
        if let Some(state) = parameters.record.as_ref().and_then(|record| record.state_at(clock.time_s())) {
            // Whoever was recorded comes where the record is by now.
            motion.state = State { heading_rad: next_to(state.heading_rad, motion.state.heading_rad), ..state };
            traffic.road_users[index].agent.state = motion.state;
            frame.vehicles[index].state = motion.state;
        }
        traffic.road_users[index].is_absent = now.is_absent();
        frame.vehicles[index].is_absent = now.is_absent();
    }
}

/// Whether a vehicle has come to the end of its route.
fn is_at_end(motion: &Motion, VehicleParameters { body, route, .. }: &VehicleParameters) -> bool {
    route.is_in_network()
        && route.along(motion.state.position()) + END_LENGTHS * (body.front_m + body.rear_m) >= route.end_m()
}
