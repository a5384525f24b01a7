//! Hysteresis between plans that are equally good: by how much another one must be better to replace the plan at hand.

use super::optimiser::Optimiser;
use super::optimum::{DescentError, Optimum};
use crate::trajectory::stage::StageSolver;

/// Another plan replaces the one at hand if it saves this share of `1 + cost`.
const MIN_COST_ADVANTAGE: f64 = 1e-3;

impl<S: StageSolver> Optimiser<S> {
    /// Whether a motion at which an exploration stopped is a better plan than the one at hand: cheaper, and safe or no less safe.
    pub(super) fn is_better(&self, reached: &Optimum, best: &Result<Optimum, DescentError>) -> bool {
        let unsafety = best.as_ref().map_or(0.0, |held| held.cost.unsafety());
        reached.cost.total < self.bar(best) && reached.cost.unsafety() <= unsafety.max(self.tolerances.slack)
    }

    /// What an optimum of another class has to cost less than. In trouble no hysteresis holds.
    pub(super) fn bar(&self, best: &Result<Optimum, DescentError>) -> f64 {
        match best {
            Ok(held) if self.tolerances.trust(best) => {
                held.cost.total - MIN_COST_ADVANTAGE * (1.0 + held.cost.total.abs())
            }
            Ok(held) => held.bar(),
            Err(_) => f64::INFINITY,
        }
    }
}
