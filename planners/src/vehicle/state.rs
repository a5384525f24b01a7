//! The basic types of motion: a vehicle's state, its input, and a trajectory of both.
//!
//! All lengths are in metres, angles in radians counter-clockwise from the x axis, times in seconds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// State of one vehicle, `x = (x, y, θ, v)` of eq. 6.1-6.4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Position of the mass centre along the world's x axis \[m\].
    #[schemars(example = 0.0)]
    pub x_m: f64,
    /// Position of the mass centre along the world's y axis \[m\].
    #[schemars(example = 0.185)]
    pub y_m: f64,
    /// Yaw angle, counter-clockwise from the x axis \[rad\].
    #[serde(default)]
    pub heading_rad: f64,
    /// Speed of the mass centre \[m/s\].
    #[schemars(example = 1.0)]
    pub speed_mps: f64,
}

impl State {
    /// The position `(x, y)` \[m\].
    pub fn position(&self) -> [f64; 2] {
        [self.x_m, self.y_m]
    }

    /// The state as the array `[x, y, θ, v]`.
    pub fn to_array(self) -> [f64; 4] {
        [self.x_m, self.y_m, self.heading_rad, self.speed_mps]
    }

    /// The state whose array is `[x, y, θ, v]`.
    pub fn from_array([x_m, y_m, heading_rad, speed_mps]: [f64; 4]) -> Self {
        State { x_m, y_m, heading_rad, speed_mps }
    }

    /// Whether every component is a finite number.
    pub fn is_finite(&self) -> bool {
        self.to_array().iter().all(|value| value.is_finite())
    }

    /// The state at a share of the way from this state to another one, interpolated component by component.
    pub fn towards(&self, other: &State, share: f64) -> State {
        let (from, to) = (self.to_array(), other.to_array());
        State::from_array(std::array::from_fn(|i| from[i] + share * (to[i] - from[i])))
    }

    /// Whether, of two vehicles that touch, this one causes the contact: it moves towards the other at least as fast as
    /// the other moves towards it.
    pub fn drives_into(&self, other: &State) -> bool {
        let [ahead_x_m, ahead_y_m] = [other.x_m - self.x_m, other.y_m - self.y_m];
        // Speeds along the line from this vehicle to the other, multiplied by its length; the other moves in the opposite direction.
        let along = |state: &State| {
            let (sin, cos) = libm::sincos(state.heading_rad);
            state.speed_mps * (cos * ahead_x_m + sin * ahead_y_m)
        };
        let [towards, others_towards] = [along(self), -along(other)];
        towards > 0.0 && towards >= others_towards
    }
}

/// Input of one vehicle, `u = (a, δ)` of eq. 6.1-6.4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Acceleration along the heading \[m/s²\].
    pub acceleration_mps2: f64,
    /// Steering angle of the front wheel \[rad\].
    pub steering_rad: f64,
}

impl Input {
    /// The input as the array `[a, δ]`.
    pub fn to_array(self) -> [f64; 2] {
        [self.acceleration_mps2, self.steering_rad]
    }

    /// The input whose array is `[a, δ]`.
    pub fn from_array([acceleration_mps2, steering_rad]: [f64; 2]) -> Self {
        Input { acceleration_mps2, steering_rad }
    }

    /// Whether both components are finite numbers.
    pub fn is_finite(&self) -> bool {
        self.to_array().iter().all(|value| value.is_finite())
    }
}

/// States at `t = 0…N` and the inputs at `t = 0…N−1` that lead from each to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// `N + 1` states, the first of them the present one.
    pub states: Vec<State>,
    /// `N` inputs.
    pub inputs: Vec<Input>,
}

impl Trajectory {
    /// The number of steps `N`.
    pub fn horizon(&self) -> usize {
        self.inputs.len()
    }

    /// The plan one step later: the first state is dropped, and the last one is extrapolated in a straight line, without further input.
    ///
    /// A trajectory without steps is returned unchanged.
    pub fn shifted(&self) -> Trajectory {
        let [.., before, last] = self.states.as_slice() else { return self.clone() };
        let end = State { x_m: 2.0 * last.x_m - before.x_m, y_m: 2.0 * last.y_m - before.y_m, ..*last };
        let states = self.states[1..].iter().copied().chain([end]).collect();
        let inputs = self.inputs[1..].iter().copied().chain([Input::default()]).collect();
        Trajectory { states, inputs }
    }

    /// The inputs of the plan one step later, with the last one repeated: an initial guess for the next plan.
    pub fn later_inputs(&self) -> Vec<Input> {
        self.inputs.iter().skip(1).chain(self.inputs.last()).copied().collect()
    }

    /// Sum over `t = 0…N−1` of the squared distance between the positions of two trajectories, `‖trj_a − trj_b‖²` of
    /// eq. 6.19-6.23 \[m²\]. The shorter horizon counts.
    pub fn squared_distance(&self, other: &Trajectory) -> f64 {
        let steps = self.horizon().min(other.horizon());
        let pairs = self.states.iter().zip(&other.states).take(steps);
        pairs.map(|(a, b)| (a.x_m - b.x_m).powi(2) + (a.y_m - b.y_m).powi(2)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(speed_mps: f64, steps: usize) -> Trajectory {
        let states = (0..=steps).map(|t| State { x_m: 0.1 * speed_mps * t as f64, speed_mps, ..State::default() });
        Trajectory { states: states.collect(), inputs: vec![Input::default(); steps] }
    }

    #[test]
    fn shifting_a_straight_plan_continues_it_by_one_step() {
        let plan = straight(1.0, 5);
        let shifted = plan.shifted();
        assert_eq!(shifted.horizon(), 5);
        for (t, state) in shifted.states.iter().enumerate() {
            assert!((state.x_m - 0.1 * (t + 1) as f64).abs() < 1e-12);
        }
    }

    #[test]
    fn the_squared_distance_of_trajectories_is_symmetric_and_omits_the_last_state() {
        let (slow, fast) = (straight(1.0, 2), straight(2.0, 2));
        assert!((slow.squared_distance(&fast) - 0.01).abs() < 1e-12);
        assert_eq!(slow.squared_distance(&fast), fast.squared_distance(&slow));
    }
}
