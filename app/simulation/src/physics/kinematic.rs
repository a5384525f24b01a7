//! The kinematic plant: every vehicle follows the bicycle model exactly, or its record, and Rapier only detects contacts.

use interplay_planners::Bicycle;
use interplay_planners::State;
use rapier2d::prelude::{PhysicsWorld, RigidBodyBuilder};

use super::contacts::{Contacts, Touch, impulse_ns};
use super::footprint::pose;
use super::gap::FootprintGaps;
use super::moving::{Contact, Moving};
use super::path::{Path, next_look};

/// A body whose pose the model sets.
pub(super) fn body(state: &State) -> RigidBodyBuilder {
    RigidBodyBuilder::kinematic_position_based().pose(pose(state, [0.0; 2]))
}

/// Advances all vehicles by a tick; returns their states at its end, and the contacts that began.
pub(super) fn advance(
    world: &mut PhysicsWorld,
    vehicles: &[Moving],
    step_s: f64,
    gaps: &mut FootprintGaps,
) -> (Vec<State>, Vec<Contact>) {
    let path = |vehicle: &Moving| Path {
        footprint: vehicle.footprint.clone(),
        from: vehicle.state,
        is_absent: vehicle.is_absent,
        to: match vehicle.recorded {
            _ if vehicle.is_absent => vehicle.state,
            Some(recorded) => recorded,
            None => Bicycle::new(&vehicle.body, step_s).step(&vehicle.state, &vehicle.input),
        },
    };
    let paths: Vec<Path> = vehicles.iter().map(path).collect();
    let (mut share, mut contacts) = (0.0, Vec::new());
    while share < 1.0 {
        share = next_look(&paths, share);
        let states: Vec<State> = paths.iter().map(|path| path.at(share)).collect();
        gaps.observe(&states, share);
        for Touch { pair: [a, b], normal } in look(world, vehicles, &states) {
            let impulse_ns = impulse_ns((&vehicles[a].body, &states[a]), (&vehicles[b].body, &states[b]), normal);
            contacts.push(Contact { pair: [a, b], share, impulse_ns });
        }
    }
    (paths.iter().map(|path| path.to).collect(), contacts)
}

/// Moves the bodies to their poses and finds the pairs that did not touch at the last check and do now.
fn look(world: &mut PhysicsWorld, vehicles: &[Moving], states: &[State]) -> Vec<Touch> {
    let origin = states.first().map(State::position).unwrap_or_default();
    for (vehicle, state) in vehicles.iter().zip(states) {
        if let Some(body) = world.bodies.get_mut(vehicle.handle) {
            body.set_enabled(!vehicle.is_absent);
            body.set_position(pose(state, origin), true);
        }
    }
    let contacts = Contacts::default();
    world.detect_collisions(&(), &contacts);
    contacts.into_touches()
}
