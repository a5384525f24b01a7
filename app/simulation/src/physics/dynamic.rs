//! The dynamic plant: Rapier's bodies have mass and move by the impulses of tyres and collisions.
//!
//! A tick is divided into sub-steps of at most a millisecond. In each, the actuators follow their commands, every vehicle's
//! tyres apply their impulse, and Rapier resolves contacts and moves the bodies. The state at the end of the tick is that of
//! the bodies: position and heading of the body, and the speed of its mass centre, negative in reverse.

use interplay_planners::State;
use interplay_scenarios::{Dynamic, Plant};
use rapier2d::prelude::{MassProperties, PhysicsWorld, RigidBody, RigidBodyBuilder, RigidBodyHandle, Vector};

use super::contacts::{Contact, Contacts, Moving, mass_kg, transmitted_ns};
use super::footprint::pose;
use super::gap::FootprintGaps;
use super::kinematic::Actuators;
use super::tyres::{Chassis, Planar};

/// The state of the dynamic plant in addition to Rapier's bodies.
#[derive(Clone)]
pub(super) struct DynamicPlant {
    settings: Dynamic,
    /// Origin of Rapier's world, chosen so that single precision suffices \[m\].
    origin: [f64; 2],
    vehicles: Vec<Vehicle>,
}

#[derive(Clone)]
struct Vehicle {
    chassis: Chassis,
    actuators: Actuators,
}

impl DynamicPlant {
    /// A plant without vehicles, in a world around `origin`.
    pub fn new(settings: Dynamic, origin: [f64; 2]) -> Self {
        DynamicPlant { settings, origin, vehicles: Vec::new() }
    }

    /// Adds a vehicle and returns its body.
    pub fn body(&mut self, body: &interplay_planners::Body, state: &State) -> RigidBodyBuilder {
        let chassis = Chassis::new(body, mass_kg(body), &self.settings);
        self.vehicles.push(Vehicle { chassis, actuators: Actuators::default() });
        let (sin, cos) = libm::sincos(state.heading_rad);
        let velocity = Vector::new((state.speed_mps * cos) as f32, (state.speed_mps * sin) as f32);
        let inertia = MassProperties::new(Vector::ZERO, chassis.mass_kg as f32, chassis.inertia_kgm2 as f32);
        RigidBodyBuilder::dynamic()
            .pose(pose(state, self.origin))
            .linvel(velocity)
            .additional_mass_properties(inertia)
            .can_sleep(false)
    }

    /// Coefficient of restitution: the ratio of separating to closing speed.
    pub fn restitution(&self) -> f32 {
        self.settings.restitution as f32
    }

    /// Advances all vehicles by a tick; returns their states at its end, and the contacts that began.
    pub fn advance(
        &mut self,
        world: &mut PhysicsWorld,
        moving: &[Moving<'_>],
        step_s: f64,
        gaps: &mut FootprintGaps,
    ) -> (Vec<State>, Vec<Contact>) {
        let steps = Plant::sub_steps(step_s);
        let sub_step_s = step_s / steps as f64;
        world.integration_parameters.dt = sub_step_s as f32;
        let mut states: Vec<State> = moving.iter().map(|vehicle| vehicle.state).collect();
        let mut found = Vec::new();
        for step in 1..=steps {
            for (vehicle, own) in moving.iter().zip(&mut self.vehicles) {
                own.actuators.follow(&vehicle.input, &self.settings, sub_step_s);
                if let Some(body) = world.bodies.get_mut(vehicle.handle) {
                    push(body, own, sub_step_s);
                }
            }
            let contacts = Contacts::default();
            world.step_with_events(&(), &contacts);
            for (vehicle, state) in moving.iter().zip(&mut states) {
                *state = self.sense(world, vehicle.handle, state);
            }
            let share = step as f64 / steps as f64;
            gaps.observe(&states, share);
            for touch in contacts.into_touches() {
                let impulse_ns = transmitted_ns(world, touch.pair.map(|index| moving[index].handle));
                found.push(Contact { pair: touch.pair, share, impulse_ns });
            }
        }
        (states, found)
    }

    /// The state of a body. Its heading is unwrapped: it differs from the heading `before` by at most π.
    fn sense(&self, world: &PhysicsWorld, handle: RigidBodyHandle, before: &State) -> State {
        let Some(body) = world.bodies.get(handle) else { return *before };
        let (place, heading, velocity) = (body.translation(), heading_rad(body), velocity(body));
        let turn = heading - before.heading_rad;
        let speed = (velocity.forward * velocity.forward + velocity.left * velocity.left).sqrt();
        State {
            x_m: self.origin[0] + f64::from(place.x),
            y_m: self.origin[1] + f64::from(place.y),
            heading_rad: before.heading_rad + libm::remainder(turn, std::f64::consts::TAU),
            speed_mps: if velocity.forward < 0.0 { -speed } else { speed },
        }
    }
}

/// Applies the impulse of a vehicle's tyres to its body.
fn push(body: &mut RigidBody, vehicle: &Vehicle, step_s: f64) {
    let now = &vehicle.actuators.now;
    let impulse = vehicle.chassis.impulse(&velocity(body), now.acceleration_mps2, now.steering_rad, step_s);
    let (sin, cos) = libm::sincos(heading_rad(body));
    let x = cos * impulse.forward - sin * impulse.left;
    let y = sin * impulse.forward + cos * impulse.left;
    body.apply_impulse(Vector::new(x as f32, y as f32), true);
    body.apply_torque_impulse(impulse.yaw as f32, true);
}

/// Yaw angle of a body, within half a turn of 0 \[rad\].
fn heading_rad(body: &RigidBody) -> f64 {
    let rotation = body.rotation();
    libm::atan2(f64::from(rotation.im), f64::from(rotation.re))
}

/// Velocity of a body in its own frame.
fn velocity(body: &RigidBody) -> Planar {
    let (x, y) = (f64::from(body.linvel().x), f64::from(body.linvel().y));
    let (sin, cos) = libm::sincos(heading_rad(body));
    Planar { forward: cos * x + sin * y, left: -sin * x + cos * y, yaw: f64::from(body.angvel()) }
}
