//! Turns Rapier's contacts into collisions.

use std::sync::Mutex;

use interplay_planners::{Body, Input, State};
use rapier2d::prelude::{
    ColliderSet, CollisionEvent, ContactPair, EventHandler, PhysicsWorld, RigidBodyHandle, RigidBodySet, SoftBodySet,
    SoftBodyTearEvent,
};

use super::footprint::{Footprint, length_m};

/// Mass of a vehicle per area of its footprint, that of a passenger car \[kg/m²\].
const AREAL_DENSITY_KG_PER_M2: f64 = 185.0;

/// Two vehicles that begin to touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Touch {
    /// Their indices, ascending.
    pub pair: [usize; 2],
    /// The direction of the contact, from the first to the second.
    pub normal: [f64; 2],
}

/// Collects the pairs that begin to touch. Rapier needs a handler that threads may share.
#[derive(Default)]
pub(super) struct Contacts(Mutex<Vec<Touch>>);

impl Contacts {
    /// All collected pairs, in the order of the indices.
    pub fn into_touches(self) -> Vec<Touch> {
        let mut touches = self.0.into_inner().unwrap_or_default();
        touches.sort_unstable_by_key(|touch| touch.pair);
        touches
    }
}

impl EventHandler for Contacts {
    fn handle_collision_event(
        &self,
        _bodies: &RigidBodySet,
        colliders: &ColliderSet,
        event: CollisionEvent,
        pair: Option<&ContactPair>,
    ) {
        let Some(pair) = pair.filter(|_| event.started()) else { return };
        let Some((manifold, _)) = pair.find_deepest_contact() else { return };
        let index = |handle| colliders.get(handle).map(|collider| collider.user_data as usize);
        if let (Some(a), Some(b), Ok(mut touches)) = (index(pair.collider1), index(pair.collider2), self.0.lock()) {
            let sign = if a < b { 1.0 } else { -1.0 };
            let normal = [sign * f64::from(manifold.data.normal.x), sign * f64::from(manifold.data.normal.y)];
            touches.push(Touch { pair: [a.min(b), a.max(b)], normal });
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

/// Mass of a vehicle: that of a passenger car, by the area of the footprint \[kg\].
pub(super) fn mass_kg(body: &Body) -> f64 {
    AREAL_DENSITY_KG_PER_M2 * length_m(body) * body.width_m
}

/// Impulse of a contact of two vehicles without dynamics \[N s\]. Rapier gives kinematic bodies no mass and thus no impulse. This is
/// the impulse that stops their approach without rebound, `m_a m_b/(m_a + m_b)` times the closing speed along the contact's
/// normal, with the mass of passenger cars.
pub(super) fn impulse_ns(a: (&Body, &State), b: (&Body, &State), normal: [f64; 2]) -> f64 {
    let reduced = mass_kg(a.0) * mass_kg(b.0) / (mass_kg(a.0) + mass_kg(b.0));
    let towards = |state: &State| {
        let (sin, cos) = libm::sincos(state.heading_rad);
        state.speed_mps * (cos * normal[0] + sin * normal[1])
    };
    reduced * (towards(a.1) - towards(b.1)).max(0.0)
}

/// Impulse between two dynamic bodies along the normal of their contact in the last sub-step \[N s\].
pub(super) fn transmitted_ns(world: &PhysicsWorld, pair: [RigidBodyHandle; 2]) -> f64 {
    let [a, b] = pair.map(|handle| world.bodies.get(handle).and_then(|body| body.colliders().first().copied()));
    let contact = a.zip(b).and_then(|(a, b)| world.narrow_phase.contact_pair(a, b));
    contact.map_or(0.0, |contact| f64::from(contact.total_impulse_magnitude()))
}

/// One vehicle at the start of a tick.
pub(super) struct Moving<'a> {
    pub handle: RigidBodyHandle,
    pub body: Body,
    pub footprint: &'a Footprint,
    pub state: State,
    pub input: Input,
    /// Whether it is not on the road: then it touches no vehicle and does not move.
    pub is_absent: bool,
    /// Its state at the end of the tick, if it follows a record.
    pub recorded: Option<State>,
}

/// Two vehicles, by their indices (ascending), that begin to touch.
pub(super) struct Contact {
    pub pair: [usize; 2],
    /// The share of the tick that has passed by then.
    pub share: f64,
    /// Impulse of the contact \[N s\].
    pub impulse_ns: f64,
}
