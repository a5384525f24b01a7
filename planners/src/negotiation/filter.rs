//! The safety filter: the planner applies its first input only if a conservative plan still exists after it.
//!
//! The negotiated input is applied only if, from the state it leads to and with the others one step further along their
//! predictions, a conservative plan still keeps its slack small. There is no guarantee if a prediction changes, so every
//! intervention is recorded. A plan that itself violates much is not applied either.

use crate::conservative::problem;
use crate::trajectory::HomotopySearch;
use crate::trajectory::{Optimiser, Optimum, Robust, Violation};
use crate::{Agent, Scene};

/// Slack that a conservative plan may need after the step.
pub(super) const MAX_VIOLATION: f64 = 2e-3;
/// It may also need this much more than the fallback needs now.
const MAX_VIOLATION_GROWTH: f64 = 1.2;
/// A proposal that itself violates safety by this much is refused. So is one that leaves the road by this many metres, or falls
/// short of persuasion by this many square metres, at 1/10 scale: its descent has ended where nothing is solved.
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
    /// Whether the first input of `optimum` may be applied.
    pub(super) fn admits(&mut self, scene: &Scene, optimum: &Optimum, fallback: &Optimum) -> bool {
        let scale = scene.ego.body.scale;
        let scales = [(Violation::Safety, 1.0), (Violation::RoadEdge, scale), (Violation::Persuasion, scale * scale)];
        if scales.iter().any(|(kind, unit)| optimum.cost.violation(*kind) > MAX_OWN_VIOLATION * unit) {
            return false;
        }
        let next = successor(scene, optimum);
        let others: Vec<&Agent> = next.others.iter().collect();
        let keep = fallback.trajectory(0).shifted().inputs;
        let allowed = MAX_VIOLATION.max(MAX_VIOLATION_GROWTH * fallback.cost.violation(Violation::Safety));
        self.optimiser
            .optimise(&problem(&next, &others), &[keep])
            .is_ok_and(|optimum| optimum.cost.violation(Violation::Safety) <= allowed)
    }
}

/// The scene after the first input, if everybody does what is predicted.
fn successor(scene: &Scene, optimum: &Optimum) -> Scene {
    let mut next = scene.clone();
    next.ego.state = optimum.iterate.states[0][1];
    next.ego.previous_input = optimum.iterate.inputs[0][0];
    for other in &mut next.others {
        other.prediction = other.prediction.shifted();
        other.state = other.prediction.states.first().copied().unwrap_or(other.state);
    }
    next
}
