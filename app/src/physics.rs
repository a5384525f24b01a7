//! Physics: the one room that names Rapier and Parry.
//!
//! With the kinematic plant every vehicle is a position-driven body that follows the bicycle model exactly, in sub-steps;
//! Rapier finds the contacts and Parry the distances between footprints. Rapier works in `f32` and the planners in `f64`:
//! the conversion is here, with positions taken relative to one vehicle where precision counts.

use std::sync::Mutex;

use bevy::ecs::prelude::*;
use interplay_planners::dynamics::Bicycle;
use interplay_planners::{Body, State};
use interplay_scenarios::Scenario;
use rapier2d::prelude::{
    ActiveCollisionTypes, ActiveEvents, ColliderBuilder, ColliderSet, CollisionEvent, ContactPair, EventHandler,
    PhysicsWorld, Pose, RigidBodyBuilder, RigidBodyHandle, RigidBodySet, SharedShape, SoftBodySet, SoftBodyTearEvent,
    Vector,
};

use crate::components::{Clock, Identity, Motion, Physique, Present};
use crate::frame::{Event, Level};
use crate::measure::{Collision, Measures};

/// Rapier steps in one tick.
const SUBSTEPS: usize = 4;
/// Mass of a vehicle per area of its footprint, that of a passenger car \[kg/m²\].
const AREAL_DENSITY: f64 = 185.0;

/// The Rapier body of a vehicle.
#[derive(Component, Clone, Copy, Debug)]
pub struct VehicleBody(pub RigidBodyHandle);

/// Rapier's world.
#[derive(Resource)]
pub struct Physics {
    world: PhysicsWorld,
}

/// Collects the pairs of vehicles that begin to touch. Rapier asks for a handler that threads may share.
#[derive(Default)]
struct Contacts(Mutex<Vec<[usize; 2]>>);

impl EventHandler for Contacts {
    fn handle_collision_event(
        &self,
        _bodies: &RigidBodySet,
        colliders: &ColliderSet,
        event: CollisionEvent,
        _pair: Option<&ContactPair>,
    ) {
        if !event.started() {
            return;
        }
        let index = |handle| colliders.get(handle).map(|collider| collider.user_data as usize);
        if let (Some(a), Some(b), Ok(mut pairs)) = (index(event.collider1()), index(event.collider2()), self.0.lock()) {
            pairs.push([a.min(b), a.max(b)]);
        }
    }

    fn handle_contact_force_event(
        &self,
        _step: f32,
        _bodies: &RigidBodySet,
        _colliders: &ColliderSet,
        _pair: &ContactPair,
        _force: f32,
    ) {
    }

    fn handle_soft_body_tear_event(&self, _bodies: &SoftBodySet, _event: &SoftBodyTearEvent) {}
}

impl Physics {
    /// An empty world at the scenario's scale.
    pub fn new(scenario: &Scenario) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::ZERO, ..PhysicsWorld::default() };
        world.integration_parameters.dt = (scenario.step_s / SUBSTEPS as f64) as f32;
        // Rapier's tolerances suit metres-long bodies; a 1/10 scale world needs them ten times smaller.
        let longest = scenario.vehicles.iter().map(|vehicle| length_m(&vehicle.body)).fold(0.0, f64::max);
        world.integration_parameters.length_unit = (longest / 4.0).clamp(0.01, 1.0) as f32;
        Physics { world }
    }

    /// Adds a vehicle.
    pub fn add(&mut self, index: usize, body: &Body, state: &State) -> RigidBodyHandle {
        let rigid = RigidBodyBuilder::kinematic_position_based().pose(pose(state, [0.0; 2]));
        let collider = ColliderBuilder::new(shape(body))
            .position(Pose::new(Vector::new(centre_m(body) as f32, 0.0), 0.0))
            .active_collision_types(ActiveCollisionTypes::all())
            .active_events(ActiveEvents::COLLISION_EVENTS)
            .user_data(index as u128);
        let (handle, _) = self.world.insert(rigid, collider);
        handle
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
    let ends: Vec<State> = moving
        .iter()
        .map(|(_, physique, motion, _)| Bicycle::new(&physique.body, clock.step_s).step(&motion.state, &motion.input))
        .collect();
    for substep in 1..=SUBSTEPS {
        let share = substep as f64 / SUBSTEPS as f64;
        for ((_, _, motion, body), end) in moving.iter().zip(&ends) {
            if let Some(rigid) = physics.world.bodies.get_mut(body.0) {
                rigid.set_next_kinematic_position(pose(&between(&motion.state, end, share), [0.0; 2]));
            }
        }
        let contacts = Contacts::default();
        physics.world.step_with_events(&(), &contacts);
        let mut pairs = contacts.0.into_inner().unwrap_or_default();
        pairs.sort_unstable();
        for [a, b] in pairs {
            let time_s = clock.time_s() + share * clock.step_s;
            let parties = [a, b].map(|index| {
                let (identity, physique, motion, _) = &moving[index];
                (identity.name.clone(), physique.body, between(&motion.state, &ends[index], share))
            });
            let collision = collision(time_s, &parties);
            let [first, second] = &collision.between;
            let text = format!("collides with {second} ({:.2} Ns)", collision.impulse_ns);
            present.0.events.push(Event { vehicle: first.clone(), level: Level::Alarm, text });
            measures.collide(collision);
        }
    }
    for ((_, _, motion, _), end) in moving.iter_mut().zip(ends) {
        motion.state = end;
    }
    clock.tick += 1;
}

/// A contact of two kinematic bodies. Rapier gives such bodies no mass and so no impulse: it is the one that would stop
/// their approach without rebound, `m_a m_b/(m_a + m_b)` times the closing speed, with the mass of passenger cars.
fn collision(time_s: f64, parties: &[(String, Body, State); 2]) -> Collision {
    let [(first, a_body, a), (second, b_body, b)] = parties;
    let mass = |body: &Body| AREAL_DENSITY * length_m(body) * body.width_m;
    let reduced = mass(a_body) * mass(b_body) / (mass(a_body) + mass(b_body));
    let velocity = |state: &State| {
        let (sin, cos) = libm::sincos(state.heading_rad);
        [state.speed_mps * cos, state.speed_mps * sin]
    };
    let (va, vb) = (velocity(a), velocity(b));
    let (dx, dy) = (b.x_m - a.x_m, b.y_m - a.y_m);
    let distance = (dx * dx + dy * dy).sqrt().max(f64::MIN_POSITIVE);
    let closing = ((va[0] - vb[0]) * dx + (va[1] - vb[1]) * dy) / distance;
    Collision { time_s, between: [first.clone(), second.clone()], impulse_ns: reduced * closing.max(0.0) }
}

/// Distance between two footprints; 0 where they touch or overlap \[m\].
pub fn gap_m(a: (&Body, &State), b: (&Body, &State)) -> f64 {
    let origin = a.1.position();
    let place = |(body, state): (&Body, &State)| {
        let offset = Pose::new(Vector::new(centre_m(body) as f32, 0.0), 0.0);
        pose(state, origin) * offset
    };
    let (shape_a, shape_b) = (shape(a.0), shape(b.0));
    let outcome = parry2d::query::distance(&place(a), &*shape_a, &place(b), &*shape_b);
    outcome.map_or(f64::INFINITY, |found| f64::from(found.distance))
}

fn length_m(body: &Body) -> f64 {
    body.front_m + body.rear_m
}

/// How far the middle of the body is ahead of its mass centre \[m\].
fn centre_m(body: &Body) -> f64 {
    0.5 * (body.front_m - body.rear_m)
}

fn shape(body: &Body) -> SharedShape {
    SharedShape::cuboid((0.5 * length_m(body)) as f32, (0.5 * body.width_m) as f32)
}

/// A state as Rapier sees it, relative to an origin.
fn pose(state: &State, origin: [f64; 2]) -> Pose {
    let position = Vector::new((state.x_m - origin[0]) as f32, (state.y_m - origin[1]) as f32);
    Pose::new(position, state.heading_rad as f32)
}

/// The state a share of the way from one to another.
fn between(from: &State, to: &State, share: f64) -> State {
    let (from, to) = (from.to_array(), to.to_array());
    State::from_array(std::array::from_fn(|i| from[i] + share * (to[i] - from[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x_m: f64, y_m: f64, heading_rad: f64) -> State {
        State { x_m, y_m, heading_rad, speed_mps: 1.0 }
    }

    #[test]
    fn gaps_of_boxes_in_closed_form() {
        let body = Body::default();
        let ahead = gap_m((&body, &at(10.0, 0.2, 0.0)), (&body, &at(11.0, 0.2, 0.0)));
        assert!((ahead - 0.6).abs() < 1e-5, "{ahead}");
        let beside = gap_m((&body, &at(10.0, 0.2, 0.0)), (&body, &at(10.1, 0.5, 0.0)));
        assert!((beside - 0.11).abs() < 1e-5, "{beside}");
        let quarter = std::f64::consts::FRAC_PI_2;
        let crossing = gap_m((&body, &at(0.0, 0.0, 0.0)), (&body, &at(1.0, -0.01, quarter)));
        assert!((crossing - (1.0 - 0.21 - 0.095)).abs() < 1e-5, "{crossing}");
        assert_eq!(gap_m((&body, &at(0.0, 0.0, 0.3)), (&body, &at(0.1, 0.05, 0.0))), 0.0);
    }
}
