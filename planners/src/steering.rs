//! Steering without an optimiser: along a road, at a lateral position.
//!
//! With the lateral error `e` and the heading error `θ`, small angles give `e′ = v θ`. The heading rate
//!
//! ```text
//! θ′ = 2/τ (θ_d − θ),   θ_d = −e/(2 τ v), at most θ_max
//! ```
//!
//! makes `e″ = −2/τ e′ − e/τ²`: critically damped, without overshoot. The bicycle turns at `θ′ = v sin β/L_r`, from which
//! follow the slip angle `β` and the steering angle `tan δ = L/L_r tan β`.

use crate::vehicle::Bicycle;
use crate::{Agent, Input, Scene, State, Trajectory};

/// Time constant `τ` \[s\].
const TIME_CONSTANT_S: f64 = 0.45;
/// Largest angle to the road, `θ_max` \[rad\].
const MAX_ANGLE_TO_ROAD_RAD: f64 = 0.4;
/// Below this speed the angles are those at this speed \[m/s\].
const MIN_STEERING_SPEED_MPS: f64 = 0.1;
/// Largest sine of the slip angle that is asked for.
const MAX_SIN_SLIP: f64 = 0.9;

/// The steering angle that leads to a lateral position on the agent's road \[rad\].
pub(crate) fn steer(agent: &Agent, state: &State, lateral_m: f64) -> f64 {
    let geometry = SteeringGeometry {
        rear_axle_m: agent.body.rear_axle_m,
        wheelbase_m: agent.body.wheelbase_m(),
        steering_max_rad: agent.limits.steering_max_rad,
    };
    let error_m = agent.corridor.across(state.position()) - lateral_m;
    geometry.correct(error_m, state.heading_rad - agent.corridor.heading_rad, state.speed_mps)
}

/// What the steering angle of a vehicle depends on besides its motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SteeringGeometry {
    /// From the mass centre to the rear axle \[m\].
    pub rear_axle_m: f64,
    /// Between the axles \[m\].
    pub wheelbase_m: f64,
    /// Largest angle \[rad\].
    pub steering_max_rad: f64,
}

impl SteeringGeometry {
    /// The steering angle that corrects a lateral error and a heading error at a speed \[rad\].
    pub fn correct(&self, error_m: f64, heading_error_rad: f64, speed_mps: f64) -> f64 {
        let speed = speed_mps.max(MIN_STEERING_SPEED_MPS);
        let wanted = (-error_m / (2.0 * TIME_CONSTANT_S * speed)).clamp(-MAX_ANGLE_TO_ROAD_RAD, MAX_ANGLE_TO_ROAD_RAD);
        let rate = 2.0 / TIME_CONSTANT_S * (wanted - heading_error_rad);
        let sin_slip = (self.rear_axle_m * rate / speed).clamp(-MAX_SIN_SLIP, MAX_SIN_SLIP);
        let tan_slip = sin_slip / (1.0 - sin_slip * sin_slip).sqrt();
        libm::atan(self.wheelbase_m / self.rear_axle_m * tan_slip).clamp(-self.steering_max_rad, self.steering_max_rad)
    }
}

/// The acceleration nearest to a wanted one that keeps acceleration and speed within their limits \[m/s²\].
pub(crate) fn admissible(agent: &Agent, state: &State, wanted_mps2: f64, step_s: f64) -> f64 {
    let limits = &agent.limits;
    let low = limits.acceleration_min_mps2.max((limits.speed_min_mps - state.speed_mps) / step_s);
    let high = limits.acceleration_max_mps2.min((limits.speed_max_mps - state.speed_mps) / step_s);
    wanted_mps2.min(high).max(low)
}

/// The motion that a rule `(t, state) ↦ input` leads to over the scene's horizon.
pub(crate) fn roll_out(scene: &Scene, mut rule: impl FnMut(usize, &State) -> Input) -> Trajectory {
    let model = Bicycle::new(&scene.ego.body, scene.step_s);
    let mut trajectory = Trajectory { states: vec![scene.ego.state], inputs: Vec::with_capacity(scene.horizon) };
    let mut state = scene.ego.state;
    for t in 0..scene.horizon {
        let input = rule(t, &state);
        state = model.step(&state, &input);
        trajectory.inputs.push(input);
        trajectory.states.push(state);
    }
    trajectory
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, crossing, scene};

    /// From any lane and heading to any lane: there, without overshoot worth the name, and along the road.
    #[test]
    fn steering_leads_to_the_lateral_position() {
        for (speed_mps, start, heading_rad) in [(1.0, 0.185, 0.0), (0.3, 0.185, 0.1), (1.5, 0.0, -0.2)] {
            let mut scene = scene(agent(0.0, start, 0.0, speed_mps), Vec::new());
            scene.ego.state.heading_rad = heading_rad;
            scene.horizon = 100;
            let drive = |_: usize, state: &State| Input {
                acceleration_mps2: 0.0,
                steering_rad: steer(&scene.ego, state, 0.555),
            };
            let trajectory = roll_out(&scene, drive);
            let end = trajectory.states.last().expect("states");
            assert!((end.y_m - 0.555).abs() < 5e-3 && end.heading_rad.abs() < 0.02, "{end:?}");
            let farthest = trajectory.states.iter().map(|state| state.y_m).fold(0.0, f64::max);
            assert!(farthest < 0.57, "{farthest}");
        }
    }

    #[test]
    fn a_road_in_another_direction_is_followed_in_the_same_way() {
        // On a road along y, the lateral coordinate is −x.
        let mut scene = scene(crossing(0.1, 0.0, 1.0), Vec::new());
        scene.horizon = 60;
        let drive =
            |_: usize, state: &State| Input { acceleration_mps2: 0.0, steering_rad: steer(&scene.ego, state, 0.1) };
        let end = *roll_out(&scene, drive).states.last().expect("states");
        assert!((end.x_m + 0.1).abs() < 5e-3 && end.y_m > 5.0, "{end:?}");
    }
}
