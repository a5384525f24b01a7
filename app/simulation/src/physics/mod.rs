//! Physics: the only folder that depends on Rapier and Parry.
//!
//! With the kinematic plant every vehicle follows the bicycle model exactly (`kinematic`). Within a tick, contacts are checked
//! often enough to miss none (`path`); at each check Rapier finds the pairs that begin to touch, and Parry the distances
//! between footprints. With the dynamic plant Rapier moves the bodies by the impulses of tyres and contacts (`dynamic`).
//! Both libraries use `f32` and the planners `f64`: this folder converts, with positions relative to a
//! vehicle, so that precision does not depend on the distance along the road.

mod contacts;
mod dynamic;
#[cfg(test)]
mod dynamic_tests;
mod footprint;
mod gap;
mod kinematic;
mod near_pairs;
#[cfg(test)]
mod tests;
mod time_to_collision;
mod tyres;

use bevy_ecs::prelude::*;
use interplay_planners::drivers::recorded::next_to;
use interplay_planners::traffic::RoadUser;
use interplay_planners::{Body, State};
use interplay_scenarios::{Outline, Plant, Scenario};
use rapier2d::prelude::{ActiveCollisionTypes, ActiveEvents, ColliderBuilder, PhysicsWorld, RigidBodyHandle, Vector};

pub use footprint::gap_m;
pub(crate) use footprint::radius_m;
pub(crate) use near_pairs::near_pairs;
pub use time_to_collision::{MovingFootprint, time_to_collision_s};

use crate::state::components::{Clock, CurrentFrame, CurrentTraffic, Fleet, MeasuredParts};
use crate::state::frame::{Collision, Event, Level, PairGap};
use contacts::{Contact, Moving};
use dynamic::DynamicPlant;
use footprint::{Footprint, length_m};
use gap::{Closest, FootprintGaps};
use kinematic::{Apart, advance_apart};

/// Largest distance of two bodies that Rapier reports as a contact, for vehicles of passenger cars' size \[m\].
const TOUCHING_M: f32 = 1e-4;
/// Friction coefficient between bodies that collide.
const BODY_FRICTION: f32 = 0.3;

/// The Rapier body of a vehicle.
#[derive(Component, Clone, Copy, Debug)]
pub struct VehicleBody(pub RigidBodyHandle);

/// Rapier's world.
#[derive(Resource)]
pub struct Physics {
    world: PhysicsWorld,
    /// The dynamic plant; without it, bodies follow the bicycle model.
    dynamic: Option<DynamicPlant>,
    gaps: FootprintGaps,
    apart: Apart,
}

impl Physics {
    /// An empty world at the scenario's scale.
    pub fn new(scenario: &Scenario) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::ZERO, ..PhysicsWorld::default() };
        // Rapier's tolerances suit metres-long bodies; a 1/10 scale world needs them ten times smaller.
        let driven = scenario.vehicles.iter().filter(|vehicle| vehicle.obstacle.is_none());
        let longest = driven.map(|vehicle| length_m(&vehicle.body)).fold(0.0, f64::max);
        world.integration_parameters.length_unit = (longest / 4.0).clamp(0.01, 1.0) as f32;
        world.integration_parameters.normalized_prediction_distance = TOUCHING_M;
        let origin = scenario.vehicles.first().map(|first| first.start.position()).unwrap_or_default();
        let dynamic = match &scenario.plant {
            Plant::Kinematic(_) => None,
            Plant::Dynamic(settings) => Some(DynamicPlant::new(*settings, origin)),
        };
        Physics { world, dynamic, gaps: FootprintGaps::new(scenario), apart: Apart::default() }
    }

    /// A copy that continues bit for bit as this world does.
    ///
    /// The narrow phase is copied too: without it, bodies that touch would begin to touch again. The copy omits
    /// Rapier's workspace, which holds nothing between steps.
    pub fn fork(&self) -> Self {
        let PhysicsWorld {
            gravity,
            integration_parameters,
            physics_pipeline: _,
            collision_pipeline: _,
            islands,
            broad_phase,
            narrow_phase,
            bodies,
            colliders,
            impulse_joints,
            multibody_joints,
            soft_bodies,
            ccd_solver: _,
        } = &self.world;
        let world = PhysicsWorld {
            gravity: *gravity,
            integration_parameters: *integration_parameters,
            islands: islands.clone(),
            broad_phase: broad_phase.clone(),
            narrow_phase: narrow_phase.clone(),
            bodies: bodies.clone(),
            colliders: colliders.clone(),
            impulse_joints: impulse_joints.clone(),
            multibody_joints: multibody_joints.clone(),
            soft_bodies: soft_bodies.clone(),
            ..PhysicsWorld::default()
        };
        Physics { world, dynamic: self.dynamic.clone(), gaps: self.gaps.clone(), apart: Apart::default() }
    }

    /// Adds a vehicle, or an obstacle with its outline.
    pub fn add(&mut self, index: usize, (body, outline): (&Body, Option<&Outline>), state: &State) -> RigidBodyHandle {
        let footprint = Footprint::new(body, outline);
        let collider = ColliderBuilder::new(footprint.shape)
            .position(footprint.centre)
            .active_collision_types(ActiveCollisionTypes::all())
            .active_events(ActiveEvents::COLLISION_EVENTS)
            .user_data(index as u128);
        let (rigid, collider) = match &mut self.dynamic {
            None => (kinematic::body(state), collider),
            Some(plant) => {
                let restitution = plant.restitution();
                (plant.body(body, state), collider.density(0.0).restitution(restitution).friction(BODY_FRICTION))
            }
        };
        let (handle, _) = self.world.insert(rigid, collider);
        handle
    }
}

/// Moves every vehicle by one tick and turns contacts into collisions.
pub fn step(
    bodies: Query<&VehicleBody>,
    fleet: Res<Fleet>,
    mut traffic: ResMut<CurrentTraffic>,
    mut physics: ResMut<Physics>,
    mut clock: ResMut<Clock>,
    mut current_frame: ResMut<CurrentFrame>,
    measured: Res<MeasuredParts>,
) {
    let (frame, road_users) = (&mut current_frame.0, &mut traffic.0.road_users);
    let Physics { world, dynamic, gaps, apart } = &mut *physics;
    gaps.is_measured = measured.gaps;
    let footprints = gaps.footprints();
    let end_s = clock.within_s(1.0);
    if dynamic.is_none()
        && !measured.gaps
        && advance_apart(apart, road_users, &footprints, clock.step_s, |user| recorded(user, end_s))
    {
        clock.tick += 1;
        return;
    }
    let moving = |((user, entity), footprint): ((&RoadUser, &Entity), _)| Moving {
        handle: bodies.get(*entity).map_or_else(|_| RigidBodyHandle::invalid(), |body| body.0),
        body: user.agent.body,
        footprint,
        state: user.agent.state,
        input: user.agent.previous_input,
        is_absent: user.is_absent(),
        recorded: recorded(user, end_s),
    };
    let moving: Vec<Moving<'_>> = road_users.iter().zip(&fleet.0).zip(&*footprints).map(moving).collect();
    let before: Vec<State> = moving.iter().map(|vehicle| vehicle.state).collect();
    frame.gap_m = gaps.begin(&before, moving.iter().map(|vehicle| vehicle.is_absent).collect());
    let (states, contacts) = match dynamic {
        None => kinematic::advance(world, &moving, clock.step_s, gaps),
        Some(plant) => plant.advance(world, &moving, clock.step_s, gaps),
    };
    gaps.observe(&states, 1.0);
    for Contact { pair: [a, b], share, impulse_ns } in contacts {
        let between = [a, b].map(|row| road_users[row].agent.name.clone());
        let text = format!("collides with {} ({impulse_ns:.2} Ns)", between[1]);
        frame.events.push(Event { vehicle: between[0].clone(), level: Level::Alarm, text });
        frame.collisions.push(Collision { time_s: clock.within_s(share), between, impulse_ns, fault: None });
        gaps.touch([a, b], share);
        for row in [a, b] {
            road_users[row].is_crashed |= dynamic.is_some();
        }
    }
    frame.smallest_gap_m = gaps.smallest_m();
    let name = |row: usize| road_users[row].agent.name.clone();
    frame.closest = gaps.closest().map(|Closest { m, pair, share }| PairGap {
        m,
        between: pair.map(name),
        time_s: clock.within_s(share),
    });
    for (user, state) in road_users.iter_mut().zip(states) {
        user.agent.state = state;
    }
    clock.tick += 1;
}

/// The recorded state of a vehicle at a time, with the heading shifted by full turns to the nearest one; `None` without a record
/// \[s\].
fn recorded(user: &RoadUser, time_s: f64) -> Option<State> {
    let state = user.record.as_ref()?.state_at(time_s)?;
    Some(State { heading_rad: next_to(state.heading_rad, user.agent.state.heading_rad), ..state })
}

/// Momentum of all bodies along x and y, and about the origin of Rapier's world \[kg m/s, kg m²/s\].
#[cfg(test)]
fn momentum(world: &World) -> [f64; 3] {
    let bodies = &world.resource::<Physics>().world.bodies;
    let parts = bodies.iter().map(|(_, body)| {
        let (mass, place, velocity) = (body.mass(), body.translation(), body.linvel());
        let spin = body.mass_properties().local_mprops.principal_inertia() * body.angvel();
        let about = mass * (place.x * velocity.y - place.y * velocity.x) + spin;
        [mass * velocity.x, mass * velocity.y, about].map(f64::from)
    });
    parts.fold([0.0; 3], |sum, part| std::array::from_fn(|i| sum[i] + part[i]))
}
