//! The motion of the ego as a solution, with the kinematic single-track model of a BMW 320i (`KS2`).
//!
//! The model is a bicycle about its rear axle, integrated exactly; a state gives the middle of the car, which is
//! [`REAR_AXLE_M`] ahead of that axle. Our model is about the mass centre, and each step moves it at its first speed and heading
//! (eq. 6.1-6.4). So these values hold at the middle of a step; at its start, their mean with those of the step before holds:
//!
//! ```text
//! θ̂ₖ = (θₖ₋₁ + θₖ)/2,   v̂ₖ = (uₖ₋₁ + uₖ)/2 with uₖ = vₖ cos βₖ, the speed of the rear axle
//! ```
//!
//! With these values an exact integration passes through our positions to second order in the step, not to first.

use std::fmt::Write;

use interplay_planners::State;

use super::DrivenVehicle;
use super::base::{Base, VERSION};
use super::goal::Arrival;
use super::xml_text::{escaped, number};

/// Vehicle model and type, and cost function, by their names in benchmarks.
const MODEL_AND_COST: &str = "KS2:WX1";
/// The distance of the rear axle from the middle of the car \[m\].
const REAR_AXLE_M: f64 = 1.422_717_093_6;
const WHEELBASE_M: f64 = 1.156_195_706_4 + REAR_AXLE_M;
const MAX_STEERING_RAD: f64 = 1.066;

#[derive(Clone, Copy, Debug, PartialEq)]
struct KinematicState {
    position: [f64; 2],
    steering_rad: f64,
    velocity_mps: f64,
    orientation_rad: f64,
}

/// The solution of the planning problem, and whether it reaches the goal; it ends there.
pub(super) fn of(base: &Base, ego: &DrivenVehicle) -> (String, bool) {
    let states = states(ego);
    let arrives = |(index, at): (usize, &KinematicState)| {
        base.goals.are_reached(&Arrival {
            time: (base.begin + index as i64) as f64,
            position: at.position,
            orientation_rad: at.orientation_rad,
            velocity_mps: at.velocity_mps,
        })
    };
    // A planning problem that is derived from the driven motion is solved when the run ends.
    let arrival =
        states.iter().enumerate().position(arrives).or_else(|| base.problem.is_none().then_some(states.len() - 1));
    let name: String = base.benchmark.chars().filter(|letter| *letter != ':' && !letter.is_whitespace()).collect();
    let mut text = format!(
        "<?xml version='1.0' encoding='UTF-8'?>\n<CommonRoadSolution benchmark_id=\"{MODEL_AND_COST}:{}:{VERSION}\">\n  \
         <ksTrajectory planningProblem=\"{}\">\n",
        escaped(&name),
        base.problem_id
    );
    for (index, at) in states.iter().enumerate().take(arrival.map_or(states.len(), |last| last + 1)) {
        let [x_m, y_m] = base.written(at.position).map(number);
        let [steering_rad, velocity_mps, orientation_rad] =
            [at.steering_rad, at.velocity_mps, at.orientation_rad].map(number);
        // Writing to a text cannot fail.
        let _ = writeln!(
            text,
            "    <ksState><x>{x_m}</x><y>{y_m}</y><steeringAngle>{steering_rad}</steeringAngle><velocity>{velocity_mps}\
             </velocity><orientation>{orientation_rad}</orientation><time>{}</time></ksState>",
            base.begin + index as i64
        );
    }
    text.push_str("  </ksTrajectory>\n</CommonRoadSolution>\n");
    (text, arrival.is_some())
}

/// The motion as states of the model.
fn states(ego: &DrivenVehicle) -> Vec<KinematicState> {
    let rear_m = ego.body.rear_axle_m;
    let wheelbase_m = rear_m + ego.body.front_axle_m;
    let steering_at = |index: usize| {
        let last = ego.steering_rad.len().saturating_sub(1);
        ego.steering_rad.get(index.min(last)).copied().unwrap_or_default()
    };
    // Values at the middle of each step: heading, speed of the rear axle, and the steering angle with the model's wheelbase.
    let midway: Vec<[f64; 3]> = ego
        .states
        .iter()
        .enumerate()
        .map(|(index, state)| {
            let tangent = libm::tan(steering_at(index));
            let slip_rad = libm::atan(rear_m / wheelbase_m * tangent);
            let steering_rad = libm::atan(tangent / wheelbase_m * WHEELBASE_M);
            [state.heading_rad, state.speed_mps * libm::cos(slip_rad), steering_rad]
        })
        .collect();
    let at_begin = |index: usize, axis: usize| match (index.checked_sub(1), midway.get(1)) {
        (Some(before), _) => 0.5 * (midway[before][axis] + midway[index][axis]),
        (None, Some(second)) => midway[0][axis] - 0.5 * (second[axis] - midway[0][axis]),
        (None, None) => midway[0][axis],
    };
    let of = |(index, state): (usize, &State)| {
        let orientation_rad = at_begin(index, 0);
        let (sin, cos) = libm::sincos(orientation_rad);
        let ahead_m = REAR_AXLE_M - rear_m;
        KinematicState {
            position: [state.x_m + ahead_m * cos, state.y_m + ahead_m * sin],
            steering_rad: at_begin(index, 2).clamp(-MAX_STEERING_RAD, MAX_STEERING_RAD),
            velocity_mps: at_begin(index, 1),
            orientation_rad,
        }
    };
    ego.states.iter().enumerate().map(of).collect()
}
