//! Steering and acceleration without an optimiser: along a road, at a lateral position.

use crate::vehicle::{Bicycle, SteeringGeometry};
use crate::{Agent, Input, Scene, State, Trajectory};

/// The steering angle that leads to a lateral position on the agent's road \[rad\].
pub(crate) fn steer(agent: &Agent, state: &State, lateral_m: f64) -> f64 {
    let geometry = SteeringGeometry {
        rear_axle_m: agent.body.rear_axle_m,
        wheelbase_m: agent.body.wheelbase_m(),
        steering_max_rad: agent.limits.steering_max_at_rad(&agent.body, state.speed_mps),
        time_ratio: agent.body.time_ratio(),
    };
    let at = agent.route.locate(state.position(), None);
    at.steer(&geometry, state, lateral_m)
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
