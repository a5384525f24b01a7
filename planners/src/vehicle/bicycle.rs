//! The kinematic bicycle of eq. 6.1-6.4, discretised with an explicit step.
//!
//! With the slip angle `β = atan(r tan δ)`, `r = L_r/L`, and `φ = θ + β`:
//!
//! ```text
//! x⁺ = x + T v cos φ          (6.1)
//! y⁺ = y + T v sin φ          (6.2)
//! θ⁺ = θ + T v sin β / L_r    (6.3: tan δ · cos β / L = sin β / L_r)
//! v⁺ = v + T a                (6.4)
//! ```
//!
//! and `β′ = r sec²δ / (1 + r² tan²δ)`, `β″ = 2 r (1 − r²) tan δ sec²δ / (1 + r² tan²δ)²`.

use super::{Body, Input, State};

/// The bicycle model of one vehicle with a fixed time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bicycle {
    /// Distance from the mass centre to the rear axle, `L_r` \[m\].
    rear_axle_m: f64,
    /// `r = L_r/L`.
    rear_share: f64,
    /// Time step `T` \[s\].
    step_s: f64,
    /// [`Body::time_ratio`].
    time_ratio: f64,
}

/// Non-zero first derivatives of the step that are not constant. `∂x⁺/∂x`, `∂y⁺/∂y`, `∂θ⁺/∂θ`, `∂v⁺/∂v` are 1 and
/// `∂v⁺/∂a` is the time step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jacobian {
    /// `∂x⁺/∂θ`.
    pub x_heading: f64,
    /// `∂y⁺/∂θ`.
    pub y_heading: f64,
    /// `∂x⁺/∂v`.
    pub x_speed: f64,
    /// `∂y⁺/∂v`.
    pub y_speed: f64,
    /// `∂θ⁺/∂v`.
    pub heading_speed: f64,
    /// `∂x⁺/∂δ`.
    pub x_steering: f64,
    /// `∂y⁺/∂δ`.
    pub y_steering: f64,
    /// `∂θ⁺/∂δ`.
    pub heading_steering: f64,
    /// `∂v⁺/∂a = T`.
    pub speed_acceleration: f64,
}

/// Non-zero second derivatives of `λ·f(x, u)`, the curvature that a multiplier `λ` of the dynamics gives the
/// Lagrangian.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DynamicsCurvature {
    /// Second derivative over the heading, `∂²/∂θ²`.
    pub heading_heading: f64,
    /// Mixed derivative over heading and speed, `∂²/∂θ∂v`.
    pub heading_speed: f64,
    /// Mixed derivative over heading and steering, `∂²/∂θ∂δ`.
    pub heading_steering: f64,
    /// Mixed derivative over speed and steering, `∂²/∂v∂δ`.
    pub speed_steering: f64,
    /// Second derivative over the steering angle, `∂²/∂δ²`.
    pub steering_steering: f64,
}

impl DynamicsCurvature {
    /// These derivatives multiplied by a number.
    pub fn scaled(&self, share: f64) -> DynamicsCurvature {
        DynamicsCurvature {
            heading_heading: share * self.heading_heading,
            heading_speed: share * self.heading_speed,
            heading_steering: share * self.heading_steering,
            speed_steering: share * self.speed_steering,
            steering_steering: share * self.steering_steering,
        }
    }
}

/// Largest sine of a slip angle on a curve.
const MAX_SIN_SLIP: f64 = 0.9;

/// The slip angle at which the mass centre of a bicycle moves along a curve: `sin β = L_r κ` (eq. 6.3). It heads that much
/// further outward than it moves \[rad\].
pub(crate) fn slip_on_curve_rad(rear_axle_m: f64, curvature_1pm: f64) -> f64 {
    libm::asin((rear_axle_m * curvature_1pm).clamp(-MAX_SIN_SLIP, MAX_SIN_SLIP))
}

/// Sine and cosine of the direction of motion `φ` and of the slip angle `β`, with the derivatives of `β`.
struct Slip {
    sin_course: f64,
    cos_course: f64,
    sin_slip: f64,
    cos_slip: f64,
    slope: f64,
    bend: f64,
}

impl Bicycle {
    /// The model of a body stepped every `step_s` seconds.
    pub fn new(body: &Body, step_s: f64) -> Self {
        let rear_share = body.rear_axle_m / body.wheelbase_m();
        Bicycle { rear_axle_m: body.rear_axle_m, rear_share, step_s, time_ratio: body.time_ratio() }
    }

    /// The time step `T` \[s\].
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// The body's [`Body::time_ratio`].
    pub(crate) fn time_ratio(&self) -> f64 {
        self.time_ratio
    }

    /// Distance from the mass centre to the rear axle, `L_r` \[m\].
    pub fn rear_axle_m(&self) -> f64 {
        self.rear_axle_m
    }

    /// Distance between the axles, `L` \[m\].
    pub fn wheelbase_m(&self) -> f64 {
        self.rear_axle_m / self.rear_share
    }

    fn slip(&self, heading_rad: f64, steering_rad: f64) -> Slip {
        let (r, tan) = (self.rear_share, libm::tan(steering_rad));
        let tan_slip = r * tan;
        let spread = 1.0 + tan_slip * tan_slip;
        let cos_slip = 1.0 / spread.sqrt();
        let sin_slip = tan_slip * cos_slip;
        let (sin, cos) = libm::sincos(heading_rad);
        let secant_squared = 1.0 + tan * tan;
        Slip {
            sin_course: sin * cos_slip + cos * sin_slip,
            cos_course: cos * cos_slip - sin * sin_slip,
            sin_slip,
            cos_slip,
            slope: r * secant_squared / spread,
            bend: 2.0 * r * (1.0 - r * r) * tan * secant_squared / (spread * spread),
        }
    }

    /// The state one step later (eq. 6.5).
    pub fn step(&self, state: &State, input: &Input) -> State {
        let slip = self.slip(state.heading_rad, input.steering_rad);
        let distance = self.step_s * state.speed_mps;
        State {
            x_m: state.x_m + distance * slip.cos_course,
            y_m: state.y_m + distance * slip.sin_course,
            heading_rad: state.heading_rad + distance * slip.sin_slip / self.rear_axle_m,
            speed_mps: state.speed_mps + self.step_s * input.acceleration_mps2,
        }
    }

    /// The states that a sequence of inputs leads to, written to `states` (`N + 1` long, its first the start).
    pub fn roll_out(&self, start: &State, inputs: &[Input], states: &mut Vec<State>) {
        states.clear();
        states.push(*start);
        let mut state = *start;
        for input in inputs {
            state = self.step(&state, input);
            states.push(state);
        }
    }

    /// First derivatives of [`Bicycle::step`].
    pub fn jacobian(&self, state: &State, input: &Input) -> Jacobian {
        let slip = self.slip(state.heading_rad, input.steering_rad);
        let distance = self.step_s * state.speed_mps;
        Jacobian {
            x_heading: -distance * slip.sin_course,
            y_heading: distance * slip.cos_course,
            x_speed: self.step_s * slip.cos_course,
            y_speed: self.step_s * slip.sin_course,
            heading_speed: self.step_s * slip.sin_slip / self.rear_axle_m,
            x_steering: -distance * slip.sin_course * slip.slope,
            y_steering: distance * slip.cos_course * slip.slope,
            heading_steering: distance * slip.cos_slip * slip.slope / self.rear_axle_m,
            speed_acceleration: self.step_s,
        }
    }

    /// Second derivatives of `λ·f` for a multiplier `λ` over `(x, y, θ, v)`.
    pub fn curvature(&self, state: &State, input: &Input, multiplier: &[f64; 4]) -> DynamicsCurvature {
        let slip = self.slip(state.heading_rad, input.steering_rad);
        let distance = self.step_s * state.speed_mps;
        let [x, y, heading, _] = *multiplier;
        let forward = x * slip.cos_course + y * slip.sin_course;
        let sideways = -x * slip.sin_course + y * slip.cos_course;
        let turn = heading / self.rear_axle_m;
        let slope_squared = slip.slope * slip.slope;
        let turn_bend = turn * (slip.cos_slip * slip.bend - slip.sin_slip * slope_squared);
        DynamicsCurvature {
            heading_heading: -distance * forward,
            heading_speed: self.step_s * sideways,
            heading_steering: -distance * forward * slip.slope,
            speed_steering: self.step_s * (sideways + turn * slip.cos_slip) * slip.slope,
            steering_steering: distance * (sideways * slip.bend - forward * slope_squared + turn_bend),
        }
    }
}

impl Jacobian {
    /// `A d + B w`: how the next state moves when state and input move by `d` (x, y, θ, v) and `w` (a, δ).
    pub fn apply(&self, d: &[f64; 4], w: &[f64; 2]) -> [f64; 4] {
        [
            d[0] + self.x_heading * d[2] + self.x_speed * d[3] + self.x_steering * w[1],
            d[1] + self.y_heading * d[2] + self.y_speed * d[3] + self.y_steering * w[1],
            d[2] + self.heading_speed * d[3] + self.heading_steering * w[1],
            d[3] + self.speed_acceleration * w[0],
        ]
    }

    /// `(Aᵀ λ, Bᵀ λ)`: the adjoint of [`Jacobian::apply`].
    pub fn apply_transposed(&self, costate: &[f64; 4]) -> ([f64; 4], [f64; 2]) {
        let [x, y, heading, speed] = *costate;
        let state = [
            x,
            y,
            self.x_heading * x + self.y_heading * y + heading,
            self.x_speed * x + self.y_speed * y + self.heading_speed * heading + speed,
        ];
        let input = [
            self.speed_acceleration * speed,
            self.x_steering * x + self.y_steering * y + self.heading_steering * heading,
        ];
        (state, input)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-6;

    fn model() -> Bicycle {
        Bicycle::new(&Body::default(), 0.1)
    }

    /// Central difference of a function of the six numbers (x, y, θ, v, a, δ) along one of them.
    fn slope<const M: usize>(f: impl Fn([f64; 6]) -> [f64; M], at: [f64; 6], axis: usize) -> [f64; M] {
        let (mut up, mut down) = (at, at);
        up[axis] += STEP;
        down[axis] -= STEP;
        let (above, below) = (f(up), f(down));
        std::array::from_fn(|i| (above[i] - below[i]) / (2.0 * STEP))
    }

    fn split(z: [f64; 6]) -> (State, Input) {
        (State::from_array([z[0], z[1], z[2], z[3]]), Input::from_array([z[4], z[5]]))
    }

    const POINTS: [[f64; 6]; 3] =
        [[0.0, 0.0, 0.0, 0.8, 0.0, 0.0], [1.0, -2.0, 0.7, 1.3, -0.5, 0.6], [0.3, 0.1, -2.5, 0.2, 1.0, -0.9]];

    #[test]
    fn the_bicycle_step_is_the_printed_equation() {
        let (state, input) = split(POINTS[1]);
        let beta = (0.19 / 0.4 * 0.6_f64.tan()).atan();
        let next = model().step(&state, &input);
        assert!((next.x_m - (1.0 + 0.13 * (0.7 + beta).cos())).abs() < 1e-14);
        assert!((next.y_m - (-2.0 + 0.13 * (0.7 + beta).sin())).abs() < 1e-14);
        assert!((next.heading_rad - (0.7 + 0.13 * 0.6_f64.tan() / 0.4 * beta.cos())).abs() < 1e-14);
        assert!((next.speed_mps - 1.25).abs() < 1e-14);
    }

    #[test]
    fn jacobian_agrees_with_finite_differences() {
        for at in POINTS {
            let (state, input) = split(at);
            let jacobian = model().jacobian(&state, &input);
            for axis in 0..6 {
                let numeric = slope(
                    |z| {
                        let (s, u) = split(z);
                        model().step(&s, &u).to_array()
                    },
                    at,
                    axis,
                );
                let mut unit = [0.0; 6];
                unit[axis] = 1.0;
                let analytic = jacobian.apply(&[unit[0], unit[1], unit[2], unit[3]], &[unit[4], unit[5]]);
                for i in 0..4 {
                    assert!((numeric[i] - analytic[i]).abs() < 1e-8, "row {i}, axis {axis}");
                }
            }
        }
    }

    #[test]
    fn the_adjoint_of_the_bicycle_step_is_its_transpose() {
        let (state, input) = split(POINTS[1]);
        let jacobian = model().jacobian(&state, &input);
        let (d, w, costate) = ([0.3, -0.1, 0.7, 0.2], [0.5, -0.4], [1.0, 2.0, -3.0, 0.5]);
        let forward: f64 = jacobian.apply(&d, &w).iter().zip(costate).map(|(a, b)| a * b).sum();
        let (state_part, input_part) = jacobian.apply_transposed(&costate);
        let backward: f64 = state_part.iter().zip(d).chain(input_part.iter().zip(w)).map(|(a, b)| a * b).sum();
        assert!((forward - backward).abs() < 1e-14);
    }

    #[test]
    fn curvature_agrees_with_finite_differences_of_the_adjoint() {
        let costate = [0.7, -1.1, 0.4, 2.0];
        for at in POINTS {
            let adjoint = |z: [f64; 6]| {
                let (s, u) = split(z);
                let (x, w) = model().jacobian(&s, &u).apply_transposed(&costate);
                [x[0], x[1], x[2], x[3], w[0], w[1]]
            };
            let (state, input) = split(at);
            let c = model().curvature(&state, &input, &costate);
            let (heading, speed, steering) = (slope(adjoint, at, 2), slope(adjoint, at, 3), slope(adjoint, at, 5));
            for (analytic, numeric) in [
                (c.heading_heading, heading[2]),
                (c.heading_speed, speed[2]),
                (c.heading_steering, heading[5]),
                (c.speed_steering, speed[5]),
                (c.steering_steering, steering[5]),
                (0.0, speed[3]),
            ] {
                assert!((analytic - numeric).abs() < 1e-8, "{analytic} against {numeric}");
            }
        }
    }
}
