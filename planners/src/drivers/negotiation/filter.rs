//! The safety filter: the planner applies its first input only if a conservative plan still exists after it.
//!
//! The negotiated input is applied only if, from the state it leads to and with the others one step further along their
//! predictions, a conservative plan still keeps its slack small. This is not guaranteed if a prediction changes, so every
//! intervention is recorded, with its reason. A plan that itself violates much is not applied either. Nothing but safety is judged: how
//! well a plan persuades does not decide whether it is refused.

use std::sync::Arc;

use crate::drivers::conservative::problem;
use crate::trajectory::HomotopySearch;
use crate::trajectory::{Optimiser, Optimum, Robust, Violation};
use crate::{Agent, Scene};

/// Slack that a conservative plan may need after the step.
pub(super) const MAX_VIOLATION: f64 = 2e-3;
/// It may also need this much more than the fallback needs now.
const MAX_VIOLATION_GROWTH: f64 = 1.2;
/// A proposal that itself violates safety by this much is refused. So is one that leaves the road by this many metres at 1/10 scale:
/// its descent has ended where nothing is solved.
const MAX_OWN_VIOLATION: f64 = 0.05;

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
        let next = successor(scene, optimum);
        let others: Vec<&Agent> = next.others.iter().collect();
        let keep = fallback.trajectory(0).shifted().inputs;
        let allowed = MAX_VIOLATION.max(MAX_VIOLATION_GROWTH * fallback.cost.violation(Violation::Safety));
        let after = self.optimiser.optimise(&problem(&next, &others), &[keep]);
        let is_safe = after.is_ok_and(|optimum| optimum.cost.violation(Violation::Safety) <= allowed);
        (!is_safe).then_some("no cautious plan would be left after its next step")
    }
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
