//! The safety filter: the planner applies its first input only if a conservative plan still exists after it.
//!
//! The negotiated input is applied only if, from the state it leads to and with the others one step further along their
//! predictions, a conservative plan still keeps its slack small. This is not guaranteed if a prediction changes, so every
//! intervention is recorded, with its reason. A plan that itself violates much is not applied either. Nothing but safety is judged: how
//! well a plan persuades does not decide whether it is refused.
//!
//! Among people, whose plans are not told, vehicles on the same road are not given the comfort of a conservative plan, but what drivers owe
//! one another: the filter asks for the gaps ahead and behind where a plan comes into another lane. A conservative plan must still exist
//! for vehicles whose way crosses or joins.

use std::sync::Arc;

use crate::drivers::conservative::problem;
use crate::drivers::lanes::RoadLanes;
use crate::plan::certificate::refused_by_motion;
use crate::scene::duties::owed_gap_m;
use crate::scene::relation::Relation;
use crate::trajectory::HomotopySearch;
use crate::trajectory::{Optimiser, Optimum, Robust, Violation};
use crate::{Agent, Scene, State, Trajectory};

/// Slack that a conservative plan may need after the step.
pub(super) const MAX_VIOLATION: f64 = 2e-3;
/// It may also need this much more than the fallback needs now.
const MAX_VIOLATION_GROWTH: f64 = 1.2;
/// A proposal that itself violates safety by this much is refused. So is one that leaves the road by this many metres at 1/10 scale:
/// its descent has ended where nothing is solved.
const MAX_OWN_VIOLATION: f64 = 0.05;

/// A body beyond the line by less is at the line, for 1/10 scale cars \[m\].
const OVER_LINE_M: f64 = 0.01;
/// A plan is judged by where it comes within this time, of real vehicles \[s\].
const SOON_S: f64 = 1.0;

#[derive(Clone, Debug)]
pub(super) struct Filter {
    optimiser: Optimiser<Robust>,
}

impl Default for Filter {
    fn default() -> Self {
        Filter { optimiser: Optimiser::receding_horizon(Robust::default()).searching(HomotopySearch::Off) }
    }
}

impl Filter {
    /// Why the first input of `optimum` may not be applied; `None` if it may.
    pub(super) fn refuses(&mut self, scene: &Scene, optimum: &Optimum, fallback: &Optimum) -> Option<&'static str> {
        let violates = |kind, unit: f64| optimum.cost.violation(kind) > MAX_OWN_VIOLATION * unit;
        if violates(Violation::Safety, 1.0) {
            return Some("its proposal comes too near to another vehicle");
        }
        if violates(Violation::RoadEdge, scene.ego.body.scale) {
            return Some("its proposal leaves the road");
        }
        let is_of_motion = scene.knowledge.is_of_motion();
        if is_of_motion && let Some(reason) = breaks_duty(scene, &optimum.trajectory(0)) {
            return Some(reason);
        }
        let next = successor(scene, optimum);
        // Of those on the same road whose motion is seen, duties are asked for, not comfort.
        let judged = |scene: &'_ Scene| -> Vec<Agent> {
            let is_judged = |other: &&Agent| !is_of_motion || !matches!(scene.ego.relation(other), Relation::Alongside);
            scene.others.iter().filter(is_judged).cloned().collect()
        };
        let others = judged(&next);
        if is_of_motion && others.is_empty() {
            return None;
        }
        let others: Vec<&Agent> = others.iter().collect();
        let keep = fallback.trajectory(0).shifted().inputs;
        let needed = if is_of_motion {
            let now = judged(scene);
            let problem = problem(scene, &now.iter().collect::<Vec<_>>());
            problem.cost(&problem.start(&[fallback.trajectory(0).inputs])).violation(Violation::Safety)
        } else {
            fallback.cost.violation(Violation::Safety)
        };
        let allowed = MAX_VIOLATION.max(MAX_VIOLATION_GROWTH * needed);
        let after = self.optimiser.optimise(&problem(&next, &others), &[keep]);
        let is_safe = after.is_ok_and(|optimum| optimum.cost.violation(Violation::Safety) <= allowed);
        (!is_safe).then_some("no cautious plan would be left after its next step")
    }
}

/// Why a plan does not do what is owed to others of whom only the motion is seen. Where it comes over the line into the lane of another
/// vehicle, there is the gap that is owed ([`owed_gap_m`]); nudging to the line needs a way back only: after the first input some last
/// resort touches no vehicle, if those behind in the lane do their duty, too.
fn breaks_duty(scene: &Scene, plan: &Trajectory) -> Option<&'static str> {
    let lanes = RoadLanes::shared_evenly(scene);
    if scene.others.iter().any(|other| comes_too_near(scene, plan, &lanes, other)) {
        return Some("the gap in the other lane is too short");
    }
    refused_by_motion(scene, plan, &[]).map(|_| "it would give away the last way out")
}

/// Whether a plan comes within a second farther over the line into the lane of another vehicle where the gap between the two is shorter than
/// the one behind owes or is owed. Once the middle of the ego is over the line, it is in that lane.
fn comes_too_near(scene: &Scene, plan: &Trajectory, lanes: &RoadLanes, other: &Agent) -> bool {
    let ego = &scene.ego;
    if other.is_obstacle || !matches!(ego.relation(other), Relation::Alongside) || !is_same_way(ego, other) {
        return false;
    }
    // How far its body is over the line of the lane in which the other one is then.
    let beyond_m = |own: &State, their: &State| {
        let [own_m, their_m] = [own, their].map(|state| ego.route.across(state.position()));
        0.5 * (ego.body.width_m + lanes.width_m()) - (own_m - lanes.centre_m(lanes.at(their_m))).abs()
    };
    let now_m = beyond_m(&ego.state, &other.state);
    if now_m > 0.5 * ego.body.width_m {
        return false;
    }
    let steps = (SOON_S * ego.body.real_ratio().sqrt() / scene.step_s).round() as usize;
    let mut pairs = plan.states.iter().zip(&other.prediction.states).skip(1).take(steps);
    pairs.any(|(own, their)| {
        if beyond_m(own, their) <= now_m.max(OVER_LINE_M * ego.body.scale) {
            return false;
        }
        let [own_m, their_m] = [own, their].map(|state| ego.route.along(state.position()));
        let is_ahead = own_m > their_m;
        let (front, rear) = if is_ahead { (&ego.body, &other.body) } else { (&other.body, &ego.body) };
        let speeds_mps = if is_ahead { [their.speed_mps, own.speed_mps] } else { [own.speed_mps, their.speed_mps] };
        let gap_m = (own_m - their_m).abs() - front.rear_m - rear.front_m;
        gap_m < owed_gap_m(rear, speeds_mps[0], speeds_mps[1])
    })
}

/// Whether two vehicles drive in one direction.
fn is_same_way(ego: &Agent, other: &Agent) -> bool {
    libm::cos(other.state.heading_rad - ego.route.heading_at(other.state.position())) > 0.0
}

/// The scene after the first input, if all vehicles move as predicted.
fn successor(scene: &Scene, optimum: &Optimum) -> Scene {
    let mut next = scene.clone();
    next.ego.state = optimum.iterate.states[0][1];
    next.ego.previous_input = optimum.iterate.inputs[0][0];
    for other in &mut next.others {
        other.prediction = Arc::new(other.prediction.shifted());
        other.state = other.prediction.states.first().copied().unwrap_or(other.state);
    }
    next
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::fixture;
    use crate::prediction::constant_velocity;

    /// A real car that keeps its motion, on a road of three lanes of 3.5 m around the x axis.
    fn car(x_m: f64, y_m: f64, heading_rad: f64) -> Agent {
        let mut agent = fixture::real_car(x_m, 25.0);
        (agent.state.y_m, agent.state.heading_rad) = (y_m, heading_rad);
        agent.prediction = Arc::new(constant_velocity(&agent.state, 30, 0.1));
        agent
    }

    /// Whether a plan that leads from the middle lane to the left is refused for another car, at a place and heading.
    fn is_refused(from_m: f64, other: &Agent) -> bool {
        let scene = fixture::scene(car(0.0, from_m, 0.04), vec![other.clone()]);
        let plan = (*scene.ego.prediction).clone();
        comes_too_near(&scene, &plan, &RoadLanes::shared_evenly(&scene), other)
    }

    #[test]
    fn a_plan_over_the_line_needs_the_gap_that_is_owed() {
        let length_m = 4.5;
        // At 25 m/s 17 m are owed; the edge of the body is at the line.
        for (gap_m, refused) in [(10.0, true), (20.0, false)] {
            for side in [-1.0, 1.0] {
                let other = car(side * (gap_m + length_m), 3.5, 0.0);
                assert_eq!(is_refused(0.8, &other), refused, "{gap_m} m, {side}");
            }
        }
    }

    #[test]
    fn a_plan_within_the_lane_or_in_the_other_one_already_needs_no_gap() {
        let near = car(-8.0, 3.5, 0.0);
        assert!(!is_refused(-1.0, &near), "it stays within its lane for a second");
        assert!(!is_refused(1.8, &near), "its middle is over the line");
        assert!(!is_refused(0.8, &car(8.0, 3.5, PI)), "the other one is oncoming");
        assert!(!is_refused(0.8, &car(-8.0, -3.5, 0.0)), "the other one is in the lane on the other side");
    }
}
