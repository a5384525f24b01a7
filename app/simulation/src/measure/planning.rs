//! How a planner does: how often it fails and how long it takes.

use crate::frame::{Origin, VehicleFrame};

/// Counts and times of one vehicle's plans.
#[derive(Clone, Debug, Default)]
pub struct Planning {
    times_ms: Vec<f64>,
    /// How long a plan may take, if the scenario says so \[ms\].
    budget_ms: Option<f64>,
    /// Plans that failed and were replaced by a fallback.
    pub failed: usize,
    /// Plans that are not optimal, because their descent reached the limit of its work: they violate nothing, or are cheaper and no
    /// less safe than going on with the plan before.
    pub unfinished: usize,
    /// Plans that were driven though they violate something, by their certificates.
    pub violating: usize,
}

impl Planning {
    /// No plan yet; with how long one may take \[ms\].
    pub fn new(budget_ms: Option<f64>) -> Self {
        Planning { budget_ms, ..Planning::default() }
    }

    /// Takes one tick.
    pub fn observe(&mut self, vehicle: &VehicleFrame) {
        if vehicle.origin == Origin::Crashed {
            return;
        }
        self.times_ms.push(vehicle.plan_ms);
        self.failed += usize::from(vehicle.origin != Origin::Planned);
        self.unfinished += vehicle.plan.statistics.unfinished;
        self.violating += usize::from(!vehicle.plan.violations.is_empty());
    }

    /// How many plans were made.
    pub fn count(&self) -> usize {
        self.times_ms.len()
    }

    /// How many plans took longer than they may, by the clock, if the scenario says how long that is.
    pub fn over_budget(&self) -> Option<usize> {
        let budget_ms = self.budget_ms?;
        Some(self.times_ms.iter().filter(|time_ms| **time_ms > budget_ms).count())
    }

    /// Wall time below which this share of the plans took \[ms\]; 0 without plans.
    pub fn quantile_ms(&self, share: f64) -> f64 {
        let mut sorted = self.times_ms.clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        sorted.get((share * last as f64).round() as usize).copied().unwrap_or(0.0)
    }
}
