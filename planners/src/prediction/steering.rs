//! Steering and acceleration without an optimiser: along a road, at a lateral position.

use crate::vehicle::{Bicycle, SteeringGeometry, slip_on_curve_rad};
use crate::{Agent, Input, Scene, State, Trajectory};

/// The steering angle that leads to a lateral position on the agent's road \[rad\].
pub(crate) fn steer(agent: &Agent, state: &State, lateral_m: f64) -> f64 {
    let at = agent.route.locate(state.position(), None);
    at.steer(&geometry(agent, state), state, lateral_m)
}

/// The same angle for a whole step of a vehicle on a curved road.
///
/// In a step of the length `h` the mass centre moves along a chord ([`Bicycle`]), which has the direction of the road in its middle,
/// at `s + h/2`. A vehicle points where the middle of its rear axle goes, so that its heading is that direction less the slip angle
/// of the curvature a length `L_r` before. In the step it turns by what this changes until the next step.
pub(crate) fn steer_over_step(agent: &Agent, state: &State, lateral_m: f64, step_s: f64) -> f64 {
    let (centre, at) = (&agent.route.centre, agent.route.locate(state.position(), None));
    let (rear_axle_m, step_m) = (agent.body.rear_axle_m, (step_s * state.speed_mps).max(MIN_STEP_M));
    let wanted_rad = |along_m: f64| {
        let slip_rad = slip_on_curve_rad(rear_axle_m, centre.at(along_m - rear_axle_m).curvature_1pm);
        centre.at(along_m).heading_rad - slip_rad
    };
    let [now_rad, next_rad] = [0.5, 1.5].map(|steps| wanted_rad(at.along_m + steps * step_m));
    let (heading_error_rad, curvature_1pm) = (state.heading_rad - now_rad, (next_rad - now_rad) / step_m);
    geometry(agent, state).correct(at.across_m - lateral_m, heading_error_rad, state.speed_mps, curvature_1pm)
}

/// Curvatures are compared over at least this distance \[m\].
const MIN_STEP_M: f64 = 1e-3;

pub(crate) fn geometry(agent: &Agent, state: &State) -> SteeringGeometry {
    SteeringGeometry {
        rear_axle_m: agent.body.rear_axle_m,
        wheelbase_m: agent.body.wheelbase_m(),
        steering_max_rad: agent.limits.steering_max_at_rad(&agent.body, state.speed_mps),
        time_ratio: agent.body.time_ratio(),
    }
}

/// The acceleration nearest to a wanted one that keeps acceleration and speed within their limits \[m/s²\].
pub(crate) fn admissible(agent: &Agent, state: &State, wanted_mps2: f64, step_s: f64) -> f64 {
    let limits = &agent.limits;
    let low = limits.acceleration_min_mps2.max((limits.speed_min_mps - state.speed_mps) / step_s);
    let high = limits.acceleration_max_mps2.min((limits.speed_max_mps - state.speed_mps) / step_s);
    wanted_mps2.min(high).max(low)
}

impl Agent {
    /// The steering angle with which it follows the curve of its road where it is \[rad\].
    pub fn steering_along_road_rad(&self) -> f64 {
        let at = self.route.locate(self.state.position(), None);
        geometry(self, &self.state).correct(0.0, 0.0, self.state.speed_mps, at.curvature_1pm)
    }

    /// The input nearest to a wanted one to which a driver changes comfortably within a time, and harder where it must.
    pub(crate) fn comfortably(&self, last: &Input, wanted: Input, speed_mps: f64, step_s: f64) -> Input {
        let turn_rad = self.limits.steering_rate_radps(self.urgency).map_or(f64::INFINITY, |rate| rate * step_s);
        let Some(comfort) = self.limits.comfort else {
            let steering_rad = self.limits.steering_towards_rad(last.steering_rad, wanted.steering_rad, step_s);
            return Input { steering_rad, ..wanted };
        };
        let jerk_mps2 = comfort.jerk_mps3 * self.urgency * self.urgency * step_s;
        let near = |last: f64, wanted: f64, most: f64| wanted.max(last - most).min(last + most);
        let next_mps = speed_mps + step_s * last.acceleration_mps2.min(0.0);
        let acceleration_mps2 = wanted.acceleration_mps2.max(-comfort.braking_at_mps2(self.urgency, next_mps));
        Input {
            acceleration_mps2: near(last.acceleration_mps2, acceleration_mps2, jerk_mps2),
            steering_rad: near(last.steering_rad, wanted.steering_rad, turn_rad),
        }
    }
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

    /// On a circle of 20 m a step turns by `v h/R`.
    #[test]
    fn wheels_along_the_road_follow_its_curve() {
        use crate::road::centre_line::Piece;
        use crate::{CentreLine, Profile, Route, fixture};
        let arc = [Piece::Arc { length_m: 60.0, curvature_1pm: 0.05 }];
        let line = CentreLine::from_pieces([0.0, 0.0], 0.0, &arc).expect("a line");
        let [right, left, half_width] = [-1.75, 1.75, 1.75].map(Profile::constant);
        let mut agent = fixture::real_car(10.0, 6.0);
        let at = line.at(10.0);
        [agent.state.x_m, agent.state.y_m] = at.position;
        agent.route = std::sync::Arc::new(Route::curved(line, right, left, half_width));
        let input = Input { acceleration_mps2: 0.0, steering_rad: agent.steering_along_road_rad() };
        let turned_rad = Bicycle::new(&agent.body, 0.1).step(&agent.state, &input).heading_rad;
        assert!((turned_rad - 6.0 * 0.1 / 20.0).abs() < 1e-6, "{turned_rad}");
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
