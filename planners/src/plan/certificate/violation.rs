//! What a plan violates: the checks.

use super::rectangles::overlap_m;
use crate::prediction::straight_on;
use crate::{Agent, Body, PlanCondition, PlanViolation, Scene, State, Trajectory};

/// States may differ from those that follow from the inputs by this share of the vehicle's length.
const STATE_TOLERANCE: f64 = 1e-6;
/// Inputs and speeds may exceed their limits by this.
const LIMIT_TOLERANCE: f64 = 1e-6;
/// Bodies may overlap, and corners be beyond the edge, by this share of the vehicle's length: planners see both as soft.
const PLACE_TOLERANCE: f64 = 5e-3;

/// Checks a plan of the planning vehicle. Returns each violated condition once, with the first stage at which it is
/// violated.
pub fn violations(scene: &Scene, plan: &Trajectory) -> Vec<PlanViolation> {
    let clear =
        scene.others.iter().map(|other| (PlanCondition::Clear(other.name.clone()), first_contact(scene, plan, other)));
    let stages = [
        (PlanCondition::Dynamics, first_wrong_state(scene, plan)),
        (PlanCondition::InputLimits, first_input_beyond(scene, plan)),
        (PlanCondition::SpeedLimits, first_speed_beyond(scene, plan)),
        (PlanCondition::Road, first_off_road(scene, plan, PLACE_TOLERANCE)),
    ];
    let found = stages.into_iter().chain(clear);
    found.filter_map(|(condition, stage)| stage.map(|stage| PlanViolation { condition, stage })).collect()
}

fn length_m(agent: &Agent) -> f64 {
    agent.body.front_m + agent.body.rear_m
}

fn first_wrong_state(scene: &Scene, plan: &Trajectory) -> Option<usize> {
    if plan.states.len() != plan.inputs.len() + 1 {
        return Some(0);
    }
    let model = scene.model();
    let tolerance = STATE_TOLERANCE * length_m(&scene.ego);
    let expected = |stage: usize| match stage {
        0 => scene.ego.state,
        _ => model.step(&plan.states[stage - 1], &plan.inputs[stage - 1]),
    };
    let is_wrong = |stage: &usize| {
        let off = plan.states[*stage].to_array().into_iter().zip(expected(*stage).to_array());
        off.into_iter()
            .any(|(found, expected)| (found - expected).abs().partial_cmp(&tolerance).is_none_or(|order| order.is_gt()))
    };
    (0..plan.states.len()).find(is_wrong)
}

/// The first input beyond the limits; the first of all, which is driven, also if the wheels cannot turn to it in time.
fn first_input_beyond(scene: &Scene, plan: &Trajectory) -> Option<usize> {
    let (limits, last_rad) = (&scene.ego.limits, scene.ego.previous_input.steering_rad);
    let is_out_of_reach = plan.inputs.first().is_some_and(|input| {
        let reached_rad = limits.steering_towards_rad(last_rad, input.steering_rad, scene.step_s);
        (input.steering_rad - reached_rad).abs() > LIMIT_TOLERANCE
    });
    if is_out_of_reach {
        return Some(0);
    }
    let accelerations = limits.acceleration_min_mps2 - LIMIT_TOLERANCE..=limits.acceleration_max_mps2 + LIMIT_TOLERANCE;
    let steering = -limits.steering_max_rad - LIMIT_TOLERANCE..=limits.steering_max_rad + LIMIT_TOLERANCE;
    plan.inputs
        .iter()
        .position(|input| !accelerations.contains(&input.acceleration_mps2) || !steering.contains(&input.steering_rad))
}

/// The first speed beyond the limits that is further beyond them than the present one.
fn first_speed_beyond(scene: &Scene, plan: &Trajectory) -> Option<usize> {
    let (limits, now_mps) = (&scene.ego.limits, scene.ego.state.speed_mps);
    let low = limits.speed_min_mps.min(now_mps) - LIMIT_TOLERANCE;
    let high = limits.speed_max_mps.max(now_mps) + LIMIT_TOLERANCE;
    plan.states.iter().position(|state| !(low..=high).contains(&state.speed_mps))
}

/// The first stage at which the body is beyond the edge of its road by more than a share of its length.
pub(super) fn first_off_road(scene: &Scene, plan: &Trajectory, share: f64) -> Option<usize> {
    let ego = &scene.ego;
    let is_off = |state: &State| !ego.route.contains(&ego.body, state, share * length_m(ego));
    if is_off(&ego.state) { None } else { plan.states.iter().position(is_off) }
}

/// How far the corners of a body are from its position \[m\]: bodies further apart than both cannot touch.
fn farthest_corner_m(body: &Body) -> f64 {
    libm::hypot(body.front_m.max(body.rear_m), 0.5 * body.width_m)
}

/// How far two vehicles can be from each other and touch \[m\].
pub(super) fn reach_m(one: &Agent, other: &Agent) -> f64 {
    [one, other].map(|agent| farthest_corner_m(&agent.body)).iter().sum::<f64>()
}

pub(super) fn is_farther(x_m: f64, y_m: f64, reach_m: f64) -> bool {
    x_m * x_m + y_m * y_m > reach_m * reach_m
}

/// The others whom a plan may touch where they are if they keep their speed and heading, which is found out without predictions:
/// all others where their roads are curved.
pub(crate) fn within_touch(scene: &Scene, plan: &Trajectory) -> Vec<Agent> {
    let may_touch = |other: &&Agent| {
        let (place, reach_m) = (straight_on(other.state, scene.step_s), reach_m(&scene.ego, other));
        let is_near = |(stage, here): (usize, &State)| {
            let there = place(stage.min(scene.horizon));
            !is_farther(here.x_m - there.x_m, here.y_m - there.y_m, reach_m)
        };
        other.route.straight().is_none() || plan.states.iter().enumerate().any(is_near)
    };
    scene.others.iter().filter(may_touch).cloned().collect()
}

/// Where a vehicle is expected to be.
pub(super) fn expected(other: &Agent, stage: usize) -> Option<&State> {
    let states = &other.prediction.states;
    states.get(stage).or(states.last())
}

/// The first stage at which the body touches that of another where it is expected to be. Where only motion is seen, it may also touch it
/// halfway from the stage before: fast vehicles pass one that crosses between two stages.
pub(super) fn first_contact(scene: &Scene, plan: &Trajectory, other: &Agent) -> Option<usize> {
    let tolerance_m = PLACE_TOLERANCE * length_m(&scene.ego);
    let reach_m = reach_m(&scene.ego, other);
    let overlap = |here: &State, there: &State| {
        !is_farther(here.x_m - there.x_m, here.y_m - there.y_m, reach_m)
            && overlap_m(&scene.ego.body.corners(here), &other.body.corners(there)) > tolerance_m
    };
    let touches = |stage: usize| expected(other, stage).is_some_and(|there| overlap(&plan.states[stage], there));
    let touches_before = |stage: usize| {
        scene.knowledge.is_of_motion()
            && expected(other, stage - 1).zip(expected(other, stage)).is_some_and(|(last, there)| {
                overlap(&halfway(&plan.states[stage - 1], &plan.states[stage]), &halfway(last, there))
            })
    };
    let mut stages = 0..plan.states.len();
    if stages.next().is_none_or(touches) {
        None
    } else {
        stages.find(|stage| touches(*stage) || touches_before(*stage))
    }
}

/// The state in the middle between two.
fn halfway(one: &State, other: &State) -> State {
    let turn_rad = libm::remainder(other.heading_rad - one.heading_rad, std::f64::consts::TAU);
    State {
        x_m: 0.5 * (one.x_m + other.x_m),
        y_m: 0.5 * (one.y_m + other.y_m),
        heading_rad: one.heading_rad + 0.5 * turn_rad,
        speed_mps: 0.5 * (one.speed_mps + other.speed_mps),
    }
}

/// Whether a motion of the planning vehicle touches another where that is expected to be, and that one is ahead then.
pub(crate) fn touches_ahead(scene: &Scene, motion: &Trajectory, other: &Agent) -> bool {
    first_contact(scene, motion, other).is_some_and(|stage| {
        let (here, there) = (&motion.states[stage], expected(other, stage));
        let (sin, cos) = libm::sincos(here.heading_rad);
        there.is_some_and(|there| (there.x_m - here.x_m) * cos + (there.y_m - here.y_m) * sin > 0.0)
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;
    use std::sync::Arc;

    use super::*;
    use crate::fixture::{self, real_car};
    use crate::prediction::constant_velocity;
    use crate::scene::Knowledge;

    /// A bicycle comes before a fast car and leaves its way between two stages.
    #[test]
    fn a_contact_between_two_stages_is_found_where_only_motion_is_seen() {
        let (step_s, ego) = (0.2, real_car(0.0, 13.0));
        let mut bicycle = Agent { name: "bicycle".to_owned(), ..real_car(0.0, 5.7) };
        bicycle.body = Body { front_m: 0.9, rear_m: 0.9, width_m: 0.6, ..bicycle.body };
        bicycle.state.heading_rad = FRAC_PI_2;
        // 0.1 m ahead of the car at stage 3, and 0.05 m beside it at stage 4.
        bicycle.state.x_m = 13.0 * 3.0 * step_s + ego.body.front_m + 0.1 + 0.3;
        bicycle.state.y_m = 0.5 * ego.body.width_m + 0.05 + 0.9 - 5.7 * 4.0 * step_s;
        bicycle.prediction = Arc::new(constant_velocity(&bicycle.state, 10, step_s));
        let plan = constant_velocity(&ego.state, 10, step_s);
        let mut scene = fixture::scene(ego, vec![bicycle.clone()]);
        (scene.step_s, scene.horizon) = (step_s, 10);
        assert_eq!(first_contact(&scene, &plan, &bicycle), None, "at the stages alone");
        scene.knowledge = Knowledge::Motion { late_steps: 0 };
        assert_eq!(first_contact(&scene, &plan, &bicycle), Some(4));
    }
}
