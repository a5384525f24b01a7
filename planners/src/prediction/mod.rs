//! Predictions of other vehicles, and simple motions that serve as starting guesses.

pub(crate) mod steering;

use std::sync::Arc;

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::prediction::steering::steer;
use crate::road::centre_line::{FrenetExpansion, FrenetPoint};
use crate::vehicle::slip_on_curve_rad;
use crate::{Agent, Body, Input, Limits, Route, Scene, State, Trajectory};

/// How a driver predicts the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Prediction {
    /// By their current plans (the source's assumption of perfect prediction); one that has not planned yet at constant
    /// velocity.
    #[default]
    Plan,
    /// At constant velocity with their present headings; along a curved road, with their present angle to it.
    ConstantVelocity,
    /// By what their motion says of their drivers: no plan is known. `inference` has the settings.
    Inferred,
}

impl Prediction {
    /// The predicted motion of a vehicle. An inferred motion is already in the scene.
    pub fn predict(self, agent: &Agent, horizon: usize, step_s: f64) -> Trajectory {
        match self {
            Prediction::Plan | Prediction::Inferred => (*agent.prediction).clone(),
            Prediction::ConstantVelocity => steadily_along(&agent.route, &agent.body, &agent.state, horizon, step_s),
        }
    }

    /// The scene with the others' motions predicted in this way.
    pub fn applied_to(self, scene: &Scene) -> Cow<'_, Scene> {
        match self {
            Prediction::Plan | Prediction::Inferred => Cow::Borrowed(scene),
            Prediction::ConstantVelocity => {
                let mut scene = scene.clone();
                for other in &mut scene.others {
                    other.prediction = Arc::new(self.predict(other, scene.horizon, scene.step_s));
                }
                Cow::Owned(scene)
            }
        }
    }
}

/// A scene for an observer that knows neither plans nor inputs nor kinds of drivers: each vehicle is expected to keep its speed
/// and its angle to the road. Goals that are shared stay.
pub fn without_plans(scene: Scene) -> Scene {
    let Scene { horizon, step_s, .. } = scene;
    let others = scene.others.into_iter().map(|other| without_plan(other, horizon, step_s));
    Scene { others: others.collect(), ..scene }
}

/// One vehicle as such an observer expects it.
pub(crate) fn without_plan(other: Agent, horizon: usize, step_s: f64) -> Agent {
    Agent {
        prediction: Arc::new(steadily_along(&other.route, &other.body, &other.state, horizon, step_s)),
        previous_input: Input::default(),
        can_be_asked: !other.is_obstacle,
        ..other
    }
}

/// Half width of the spread of an observed position along the road, of real vehicles \[m\].
const SPREAD_M: f64 = 0.25;
/// Half width of the spread of an acceleration \[m/s²\].
const SPREAD_MPS2: f64 = 0.5;

/// The half width of the spread of the place along the road of a vehicle of which only the motion is seen, after some time \[m\]:
/// `σ₀ + σ_a t²/2`.
pub fn spread_m(body: &Body, time_s: f64) -> f64 {
    SPREAD_M * body.real_ratio() + 0.5 * SPREAD_MPS2 * time_s * time_s
}

/// The motion of a vehicle that keeps its present heading and speed.
pub fn constant_velocity(state: &State, horizon: usize, step_s: f64) -> Trajectory {
    Trajectory {
        states: (0..=horizon).map(straight_on(*state, step_s)).collect(),
        inputs: vec![Input::default(); horizon],
    }
}

/// Where a vehicle that keeps its present heading and speed is after some steps.
pub(crate) fn straight_on(state: State, step_s: f64) -> impl Fn(usize) -> State {
    let (sin, cos) = libm::sincos(state.heading_rad);
    move |steps| {
        let distance = state.speed_mps * step_s * steps as f64;
        State { x_m: state.x_m + distance * cos, y_m: state.y_m + distance * sin, ..state }
    }
}

/// The motion of a vehicle that keeps its speed and its angle to the road: on a straight road [`constant_velocity`].
///
/// In Frenet coordinates, with the angle `φ` of the motion to the road: `s′ = v cos φ/(1 − κ n)`, `n′ = v sin φ`, by Euler's
/// method. The motion leads outward of the heading by the slip angle of the curve.
pub fn steadily_along(route: &Route, body: &Body, state: &State, horizon: usize, step_s: f64) -> Trajectory {
    if route.straight().is_some() {
        return constant_velocity(state, horizon, step_s);
    }
    let mut at = route.locate(state.position(), None);
    let slip_rad = |at: &FrenetPoint| {
        let stretch = (1.0 - at.curvature_1pm * at.across_m).max(FrenetExpansion::MIN_STRETCH);
        slip_on_curve_rad(body.rear_axle_m, at.curvature_1pm / stretch)
    };
    let angle_rad = state.heading_rad + slip_rad(&at) - at.heading_rad;
    let (sin, cos) = libm::sincos(angle_rad);
    let mut states = vec![*state];
    for _ in 0..horizon {
        let stretch = (1.0 - at.curvature_1pm * at.across_m).max(FrenetExpansion::MIN_STRETCH);
        let along_m = at.along_m + step_s * state.speed_mps * cos / stretch;
        let across_m = at.across_m + step_s * state.speed_mps * sin;
        let point = route.centre.at(along_m);
        at = FrenetPoint { along_m, across_m, heading_rad: point.heading_rad, curvature_1pm: point.curvature_1pm };
        let [x_m, y_m] = route.position(along_m, across_m);
        states.push(State { x_m, y_m, heading_rad: point.heading_rad + angle_rad - slip_rad(&at), ..*state });
    }
    Trajectory { states, inputs: vec![Input::default(); horizon] }
}

/// Inputs of a constant acceleration of the planning vehicle: without steering on a straight road, along a curved one at the
/// present lateral position, or at the nearest one at which the body is on the road.
pub fn steady_inputs(scene: &Scene, acceleration_mps2: f64) -> Vec<Input> {
    let ego = &scene.ego;
    let mut inputs = steady(&ego.state, acceleration_mps2, &ego.limits, scene.horizon, scene.step_s);
    if ego.route.straight().is_none() {
        let (at, half_m) = (ego.place(), 0.5 * ego.body.width_m);
        let [right_m, left_m] = ego.route.edges_before_end_m(at.along_m);
        let across_m = at.across_m.min(left_m - half_m).max(right_m + half_m);
        let (model, mut state, mut last_rad) = (scene.model(), ego.state, ego.previous_input.steering_rad);
        for input in &mut inputs {
            last_rad = ego.limits.steering_towards_rad(last_rad, steer(ego, &state, across_m), scene.step_s);
            input.steering_rad = last_rad;
            state = model.step(&state, input);
        }
    }
    inputs
}

/// Inputs of a constant acceleration without steering. The acceleration is reduced where the speed would leave its limits.
pub fn steady(state: &State, acceleration_mps2: f64, limits: &Limits, horizon: usize, step_s: f64) -> Vec<Input> {
    let mut speed = state.speed_mps;
    let inputs = (0..horizon).map(|_| {
        let low = (limits.speed_min_mps - speed) / step_s;
        let high = (limits.speed_max_mps - speed) / step_s;
        let acceleration_mps2 = acceleration_mps2.min(high).max(low);
        speed += step_s * acceleration_mps2;
        Input { acceleration_mps2, steering_rad: 0.0 }
    });
    inputs.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Bicycle;

    #[test]
    fn constant_velocity_is_the_bicycle_without_input() {
        let state = State { x_m: 1.0, y_m: -1.0, heading_rad: 0.8, speed_mps: 1.2 };
        let predicted = constant_velocity(&state, 30, 0.1);
        let mut states = Vec::new();
        Bicycle::new(&Body::default(), 0.1).roll_out(&state, &predicted.inputs, &mut states);
        for (a, b) in predicted.states.iter().zip(&states) {
            assert!((a.x_m - b.x_m).abs() < 1e-12 && (a.y_m - b.y_m).abs() < 1e-12);
        }
    }

    /// The body is beyond the right edge by a metre at first, and its wheels turn slowly.
    #[test]
    fn a_steady_motion_leads_back_onto_the_road() {
        use crate::{CentreLine, Profile, fixture};
        let mut ego = fixture::real_car(0.0, 8.0);
        let [right, left, half_width] = [-1.75, 1.75, 1.75].map(Profile::constant);
        ego.route = Arc::new(Route::curved(CentreLine::straight(0.0), right, left, half_width));
        ego.state.y_m = -1.75 + 0.5 * ego.body.width_m - 1.0;
        ego.limits.steering_rate_max_radps = Some(0.4);
        let mut scene = fixture::scene(ego, Vec::new());
        (scene.step_s, scene.horizon) = (0.2, 40);
        let inputs = steady_inputs(&scene, -0.5);
        let turns = inputs.windows(2).map(|pair| (pair[1].steering_rad - pair[0].steering_rad).abs());
        assert!(turns.fold(inputs[0].steering_rad.abs(), f64::max) < 0.08 + 1e-9);
        let mut states = Vec::new();
        scene.model().roll_out(&scene.ego.state, &inputs, &mut states);
        assert!(scene.ego.route.contains(&scene.ego.body, states.last().expect("states"), 0.1), "{states:?}");
    }

    #[test]
    fn a_steady_brake_ends_at_rest() {
        let state = State { speed_mps: 0.55, ..State::default() };
        let inputs = steady(&state, -1.0, &Limits::default(), 10, 0.1);
        let speed: f64 = 0.55 + inputs.iter().map(|input| 0.1 * input.acceleration_mps2).sum::<f64>();
        assert!(speed.abs() < 1e-12);
        assert!((inputs[5].acceleration_mps2 + 0.5).abs() < 1e-9 && inputs[6].acceleration_mps2.abs() < 1e-9);
    }

    #[test]
    fn the_spread_grows_with_the_square_of_time() {
        let vehicle = crate::fixture::real_car(0.0, 20.0);
        let [now, later] = [0.0, 2.0].map(|time_s| spread_m(&vehicle.body, time_s));
        assert!((later - now - 1.0).abs() < 1e-12);
    }
}
