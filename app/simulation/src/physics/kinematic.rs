//! The kinematic plant: every vehicle follows the bicycle model exactly, or its record, and Rapier only detects contacts.
//!
//! Actuators: commands take effect with a lag and a rate limit.
//!
//! An actuator with the value `u` and the command `w` obeys `τ u′ = w − u`, and changes by no more than `u′_max` per second. Over
//! a sub-step `h` with constant `w` the lag alone gives `u⁺ = w + (u − w) e^(−h/τ)`, whatever `τ ≥ 0`.

use interplay_planners::traffic::RoadUser;
use interplay_planners::{Bicycle, Input, State};
use interplay_scenarios::Dynamic;
use rapier2d::prelude::{PhysicsWorld, RigidBodyBuilder};

use super::contacts::{Contact, Contacts, Moving, Touch, impulse_ns};
use super::footprint::{Footprint, pose};
use super::gap::{FootprintGaps, Path, Sweep, next_look};

/// A body whose pose the model sets.
pub(super) fn body(state: &State) -> RigidBodyBuilder {
    RigidBodyBuilder::kinematic_position_based().pose(pose(state, [0.0; 2]))
}

/// What [`advance_apart`] keeps from tick to tick: memory alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Apart {
    ends: Vec<State>,
    sweep: Sweep,
}

/// Advances all vehicles by a tick if no two of them may touch in it; returns whether it has. `recorded` is the state at the end of the tick
/// of a vehicle that follows a record. The engine has no part in it.
pub(super) fn advance_apart(
    Apart { ends, sweep }: &mut Apart,
    road_users: &mut [RoadUser],
    footprints: &[Footprint],
    step_s: f64,
    recorded: impl Fn(&RoadUser) -> Option<State>,
) -> bool {
    ends.clear();
    ends.extend(road_users.iter().map(|user| {
        let RoadUser { agent, .. } = user;
        let stays = user.is_absent().then_some(agent.state);
        let driven = || Bicycle::new(&agent.body, step_s).step(&agent.state, &agent.previous_input);
        stays.or_else(|| recorded(user)).unwrap_or_else(driven)
    }));
    let path = |row: usize| Path {
        footprint: &footprints[row],
        is_absent: road_users[row].is_absent(),
        from: road_users[row].agent.state,
        to: ends[row],
    };
    if sweep.may_touch(road_users.len(), path) {
        return false;
    }
    for (user, end) in road_users.iter_mut().zip(ends) {
        user.agent.state = *end;
    }
    true
}

/// Advances all vehicles by a tick; returns their states at its end, and the contacts that began.
pub(super) fn advance<'a>(
    world: &mut PhysicsWorld,
    vehicles: &[Moving<'a>],
    step_s: f64,
    gaps: &mut FootprintGaps,
) -> (Vec<State>, Vec<Contact>) {
    let path = |vehicle: &Moving<'a>| Path {
        footprint: vehicle.footprint,
        from: vehicle.state,
        is_absent: vehicle.is_absent,
        to: match vehicle.recorded {
            _ if vehicle.is_absent => vehicle.state,
            Some(recorded) => recorded,
            None => Bicycle::new(&vehicle.body, step_s).step(&vehicle.state, &vehicle.input),
        },
    };
    let paths: Vec<Path<'_>> = vehicles.iter().map(path).collect();
    // The engine is asked only in ticks in which two vehicles may touch; distances within the tick are measured at the same times in all.
    let may_touch = Sweep::default().may_touch(paths.len(), |row| paths[row]);
    let (mut share, mut contacts) = (0.0, Vec::new());
    while share < 1.0 && (may_touch || gaps.is_measured) {
        share = next_look(&paths, share);
        let states: Vec<State> = paths.iter().map(|path| path.at(share)).collect();
        gaps.observe(&states, share);
        if !may_touch {
            continue;
        }
        for Touch { pair: [a, b], normal } in look(world, vehicles, &states) {
            let impulse_ns = impulse_ns((&vehicles[a].body, &states[a]), (&vehicles[b].body, &states[b]), normal);
            contacts.push(Contact { pair: [a, b], share, impulse_ns });
        }
    }
    (paths.iter().map(|path| path.to).collect(), contacts)
}

/// Moves the bodies to their poses and finds the pairs that did not touch at the last check and do now.
fn look(world: &mut PhysicsWorld, vehicles: &[Moving<'_>], states: &[State]) -> Vec<Touch> {
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

/// The present values of a vehicle's actuators.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Actuators {
    /// Acceleration and steering angle.
    pub now: Input,
}

impl Actuators {
    /// Advances the actuators by a sub-step with the command `wanted`.
    pub fn follow(&mut self, wanted: &Input, plant: &Dynamic, step_s: f64) {
        let Input { acceleration_mps2, steering_rad } = &mut self.now;
        let (jerk, rate) = (plant.jerk_max_mps3, plant.steering_rate_max_radps);
        *acceleration_mps2 +=
            change(wanted.acceleration_mps2 - *acceleration_mps2, plant.acceleration_lag_s, jerk, step_s);
        *steering_rad += change(wanted.steering_rad - *steering_rad, plant.steering_lag_s, rate, step_s);
    }
}

/// The change of a value that misses its command by `missing`.
fn change(missing: f64, lag_s: f64, rate_max: f64, step_s: f64) -> f64 {
    let share = if lag_s > 0.0 { 1.0 - libm::exp(-step_s / lag_s) } else { 1.0 };
    let most = rate_max * step_s;
    (share * missing).clamp(-most, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUB_STEP_S: f64 = 1e-3;

    /// The steering angle after some steps with a constant command, from zero.
    fn steered(wanted_rad: f64, plant: &Dynamic, steps: u32) -> f64 {
        let (mut actuators, wanted) = (Actuators::default(), Input { steering_rad: wanted_rad, ..Input::default() });
        for _ in 0..steps {
            actuators.follow(&wanted, plant, SUB_STEP_S);
        }
        actuators.now.steering_rad
    }

    #[test]
    fn an_actuator_lag_is_exponential_and_zero_lag_has_no_delay() {
        let plant = Dynamic { steering_lag_s: 0.07, ..Dynamic::default() };
        let expected = 0.1 * (1.0 - libm::exp(-0.05 / 0.07));
        assert!((steered(0.1, &plant, 50) - expected).abs() < 1e-12);
        let prompt = Dynamic { steering_lag_s: 0.0, steering_rate_max_radps: 1e6, ..plant };
        assert_eq!(steered(0.1, &prompt, 1), 0.1);
    }

    #[test]
    fn a_rate_limited_actuator_follows_a_ramp() {
        let plant = Dynamic { steering_lag_s: 0.0, steering_rate_max_radps: 2.0, ..Dynamic::default() };
        assert!((steered(-0.5, &plant, 100) + 0.2).abs() < 1e-12);
        assert!((steered(-0.5, &plant, 400) + 0.5).abs() < 1e-12);
    }
}
