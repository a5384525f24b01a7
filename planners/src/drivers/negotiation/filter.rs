//! The safety filter: the planner applies its first input only if a conservative plan still exists after it.
//!
//! The negotiated input is applied only if, from the state it leads to and with the others one step further along their
//! predictions, a conservative plan still keeps its slack small. This is not guaranteed if a prediction changes, so every
//! intervention is recorded, with its reason. A plan that itself violates much is not applied either. Nothing but safety is judged: how
//! well a plan persuades does not decide whether it is refused.
//!
//! Among people, whose plans are not told, the filter does not ask for the comfort of a conservative plan, but for what drivers owe one
//! another.

use std::sync::Arc;

use crate::drivers::conservative::problem;
use crate::plan::certificate::refused_by_motion;
use crate::scene::duties::owed_gap_m;
use crate::scene::relation::Relation;
use crate::trajectory::HomotopySearch;
use crate::trajectory::{Optimiser, Optimum, Robust, Violation};
use crate::{Agent, Scene, Trajectory};

/// Slack that a conservative plan may need after the step.
pub(super) const MAX_VIOLATION: f64 = 2e-3;
/// It may also need this much more than the fallback needs now.
const MAX_VIOLATION_GROWTH: f64 = 1.2;
/// A proposal that itself violates safety by this much is refused. So is one that leaves the road by this many metres at 1/10 scale:
/// its descent has ended where nothing is solved.
const MAX_OWN_VIOLATION: f64 = 0.05;

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
        if scene.knowledge.is_of_motion() {
            return breaks_duty(scene, &optimum.trajectory(0));
        }
        let next = successor(scene, optimum);
        let others: Vec<&Agent> = next.others.iter().collect();
        let keep = fallback.trajectory(0).shifted().inputs;
        let allowed = MAX_VIOLATION.max(MAX_VIOLATION_GROWTH * fallback.cost.violation(Violation::Safety));
        let after = self.optimiser.optimise(&problem(&next, &others), &[keep]);
        let is_safe = after.is_ok_and(|optimum| optimum.cost.violation(Violation::Safety) <= allowed);
        (!is_safe).then_some("no cautious plan would be left after its next step")
    }
}

/// Why a plan does not do what is owed to others of whom only the motion is seen. Before it comes into the lane of a vehicle behind, that
/// one has the gap that is owed to it ([`owed_gap_m`]); nudging to the line needs a way back only: after the first input some last resort
/// touches no vehicle, if those behind in the lane do their duty, too.
fn breaks_duty(scene: &Scene, plan: &Trajectory) -> Option<&'static str> {
    if scene.others.iter().any(|other| comes_too_near_before(scene, plan, other)) {
        return Some("the gap before the vehicle behind is too short");
    }
    refused_by_motion(scene, plan, &[]).map(|_| "it would give away the last way out")
}

/// Whether a plan comes within a second into the lane of a vehicle behind that does not have its gap then.
fn comes_too_near_before(scene: &Scene, plan: &Trajectory, other: &Agent) -> bool {
    let ego = &scene.ego;
    let is_beside = matches!(ego.relation(other), Relation::Alongside) && !ego.shares_lane_with(other);
    if other.is_obstacle || !is_beside || !is_same_way(ego, other) {
        return false;
    }
    let steps = (SOON_S * ego.body.real_ratio().sqrt() / scene.step_s).round() as usize;
    let half_m = 0.5 * (ego.body.width_m + other.body.width_m);
    let pairs = plan.states.iter().zip(&other.prediction.states).skip(1).take(steps);
    let comes = pairs.map(|(own, their)| (own, their, [own, their].map(|state| ego.route.across(state.position()))));
    let mut within = comes.filter(|(_, _, [own_m, their_m])| (own_m - their_m).abs() < half_m);
    within.next().is_some_and(|(own, their, _)| {
        let [own_m, their_m] = [own, their].map(|state| ego.route.along(state.position()));
        let gap_m = own_m - ego.body.rear_m - their_m - other.body.front_m;
        own_m > their_m && gap_m < owed_gap_m(&other.body, their.speed_mps, own.speed_mps)
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
