//! Physics: the one room that names Rapier and Parry.
//!
//! With the kinematic plant every vehicle follows the bicycle model exactly. Within a tick the bodies are looked at as often
//! as it takes to miss no contact (`path`); each time Rapier finds who begins to touch, and Parry the distances between
//! footprints. Both work in `f32` and the planners in `f64`: the conversion is here, with positions taken relative to a
//! vehicle, so that precision does not depend on how far along the road one is.

mod contacts;
mod footprint;
mod path;
#[cfg(test)]
mod tests;

use bevy::ecs::prelude::*;
use interplay_planners::dynamics::Bicycle;
use interplay_planners::{Body, State};
use interplay_scenarios::Scenario;
use rapier2d::prelude::{
    ActiveCollisionTypes, ActiveEvents, ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, Vector,
};

pub use footprint::gap_m;

use crate::components::{Clock, Identity, Motion, Physique, Present};
use crate::frame::{Event, Level};
use crate::measure::{Collision, Measures};
use contacts::{Contacts, Touch, impulse_ns};
use footprint::{centre, length_m, pose, shape};
use path::{Path, next_look};

/// From which distance on Rapier speaks of a contact, for vehicles of passenger cars' size \[m\].
const TOUCHING_M: f32 = 1e-4;

/// The Rapier body of a vehicle.
#[derive(Component, Clone, Copy, Debug)]
pub struct VehicleBody(pub RigidBodyHandle);

/// Rapier's world.
#[derive(Resource)]
pub struct Physics {
    world: PhysicsWorld,
}

impl Physics {
    /// An empty world at the scenario's scale.
    pub fn new(scenario: &Scenario) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::ZERO, ..PhysicsWorld::default() };
        // Rapier's tolerances suit metres-long bodies; a 1/10 scale world needs them ten times smaller.
        let longest = scenario.vehicles.iter().map(|vehicle| length_m(&vehicle.body)).fold(0.0, f64::max);
        world.integration_parameters.length_unit = (longest / 4.0).clamp(0.01, 1.0) as f32;
        world.integration_parameters.normalized_prediction_distance = TOUCHING_M;
        Physics { world }
    }

    /// Adds a vehicle.
    pub fn add(&mut self, index: usize, body: &Body, state: &State) -> RigidBodyHandle {
        let rigid = RigidBodyBuilder::kinematic_position_based().pose(pose(state, [0.0; 2]));
        let collider = ColliderBuilder::new(shape(body))
            .position(centre(body))
            .active_collision_types(ActiveCollisionTypes::all())
            .active_events(ActiveEvents::COLLISION_EVENTS)
            .user_data(index as u128);
        let (handle, _) = self.world.insert(rigid, collider);
        handle
    }

    /// Puts the bodies at their places and finds who did not touch at the last ones and does now.
    fn look(&mut self, bodies: &[RigidBodyHandle], states: &[State]) -> Vec<Touch> {
        let origin = states.first().map(State::position).unwrap_or_default();
        for (handle, state) in bodies.iter().zip(states) {
            if let Some(body) = self.world.bodies.get_mut(*handle) {
                body.set_position(pose(state, origin), true);
            }
        }
        let contacts = Contacts::default();
        self.world.detect_collisions(&(), &contacts);
        contacts.into_touches()
    }
}

/// Moves every vehicle by one tick and turns contacts into collisions.
pub fn step(
    mut vehicles: Query<(&Identity, &Physique, &mut Motion, &VehicleBody)>,
    mut physics: ResMut<Physics>,
    mut clock: ResMut<Clock>,
    mut present: ResMut<Present>,
    mut measures: ResMut<Measures>,
) {
    let mut moving: Vec<_> = vehicles.iter_mut().collect();
    moving.sort_by_key(|(identity, ..)| identity.index);
    let path = |physique: &Physique, motion: &Motion| Path {
        body: physique.body,
        from: motion.state,
        to: Bicycle::new(&physique.body, clock.step_s).step(&motion.state, &motion.input),
    };
    let paths: Vec<Path> = moving.iter().map(|(_, physique, motion, _)| path(physique, motion)).collect();
    let bodies: Vec<RigidBodyHandle> = moving.iter().map(|(.., body)| body.0).collect();
    let mut share = 0.0;
    while share < 1.0 {
        share = next_look(&paths, share);
        let states: Vec<State> = paths.iter().map(|path| path.at(share)).collect();
        measures.gap.observe(&states);
        for Touch { pair: [a, b], normal } in physics.look(&bodies, &states) {
            let impulse_ns = impulse_ns((&paths[a].body, &states[a]), (&paths[b].body, &states[b]), normal);
            let between = [a, b].map(|index| moving[index].0.name.clone());
            let text = format!("collides with {} ({impulse_ns:.2} Ns)", between[1]);
            present.0.events.push(Event { vehicle: between[0].clone(), level: Level::Alarm, text });
            let time_s = clock.within_s(share);
            measures.collide([a, b], Collision { time_s, between, impulse_ns });
        }
    }
    for ((_, _, motion, _), path) in moving.iter_mut().zip(paths) {
        motion.state = path.to;
    }
    clock.tick += 1;
}
