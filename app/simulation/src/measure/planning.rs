//! Measures of a planner: failures and times.

use interplay_planners::scene::driver_estimate::DriverEstimate;

use crate::state::frame::{Origin, VehicleFrame};

/// Counts and times of one vehicle's plans.
#[derive(Clone, Debug, Default)]
pub struct Planning {
    times_ms: Vec<f64>,
    /// Time budget of a plan, if the scenario states one \[ms\].
    budget_ms: Option<f64>,
    /// Plans that failed and were replaced by a fallback.
    pub failed: usize,
    /// Plans that are not optimal because the optimiser reached its iteration limit: they violate nothing, or are cheaper and at
    /// least as safe as continuing the plan before.
    pub unfinished: usize,
    /// Plans that were driven although they violate a constraint, by their certificates.
    pub violating: usize,
}

impl Planning {
    /// Begins without a plan; `budget_ms` is the time budget of a plan \[ms\].
    pub fn new(budget_ms: Option<f64>) -> Self {
        Planning { budget_ms, ..Planning::default() }
    }

    /// Updates the counts and times with one tick.
    pub fn observe(&mut self, vehicle: &VehicleFrame) {
        if vehicle.origin == Origin::Crashed {
            return;
        }
        self.times_ms.push(vehicle.plan_ms);
        self.failed += usize::from(vehicle.origin != Origin::Planned);
        self.unfinished += vehicle.plan.statistics.unfinished;
        self.violating += usize::from(!vehicle.plan.violations.is_empty());
    }

    /// Number of plans.
    pub fn count(&self) -> usize {
        self.times_ms.len()
    }

    /// Number of plans that exceeded the time budget, by the clock, if the scenario states one.
    pub fn over_budget(&self) -> Option<usize> {
        let budget_ms = self.budget_ms?;
        Some(self.times_ms.iter().filter(|time_ms| **time_ms > budget_ms).count())
    }

    /// Quantile of the wall times of plans \[ms\]; 0 without plans.
    pub fn quantile_ms(&self, share: f64) -> f64 {
        let mut sorted = self.times_ms.clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        sorted.get((share * last as f64).round() as usize).copied().unwrap_or(0.0)
    }
}

/// The latest beliefs of one vehicle's driver about the others.
#[derive(Clone, Debug, Default)]
pub struct Beliefs(Vec<HeldBelief>);

/// A belief of a driver.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldBelief {
    /// The latest estimate.
    pub estimate: DriverEstimate,
    /// Time since when the other has been classified as this kind of driver \[s\].
    pub since_s: f64,
}

impl Beliefs {
    /// Updates the beliefs with the estimates of one tick; beliefs about vehicles that are out of sight are kept.
    pub fn observe(&mut self, estimates: &[DriverEstimate], time_s: f64) {
        for estimate in estimates {
            match self.0.iter_mut().find(|held| held.estimate.vehicle == estimate.vehicle) {
                Some(held) => {
                    if held.estimate.model != estimate.model {
                        held.since_s = time_s;
                    }
                    held.estimate = estimate.clone();
                }
                None => self.0.push(HeldBelief { estimate: estimate.clone(), since_s: time_s }),
            }
        }
    }

    /// The latest beliefs, in the order in which the others were first seen.
    pub fn held(&self) -> impl Iterator<Item = &HeldBelief> {
        self.0.iter()
    }
}

#[cfg(test)]
mod tests {
    use interplay_planners::Plan;
    use interplay_planners::scene::driver_estimate::DriverModel;
    use interplay_planners::trajectory::Statistics;

    use super::*;

    fn tick(plan_ms: f64, origin: Origin, unfinished: usize) -> VehicleFrame {
        let statistics = Statistics { unfinished, ..Statistics::default() };
        let plan = Plan { statistics, ..Plan::default() }.into();
        VehicleFrame { plan_ms, origin, plan, ..VehicleFrame::default() }
    }

    #[test]
    fn plans_are_counted_by_their_outcome() {
        let mut planning = Planning::new(Some(2.0));
        assert_eq!((planning.count(), planning.quantile_ms(0.5)), (0, 0.0));
        let times_ms = [5.0, 1.0, 2.0, 3.0, 4.0];
        for (at, plan_ms) in times_ms.into_iter().enumerate() {
            let origin = [Origin::Continued, Origin::Braking].get(at).copied().unwrap_or_default();
            planning.observe(&tick(plan_ms, origin, at));
        }
        planning.observe(&tick(100.0, Origin::Crashed, 1));
        assert_eq!((planning.count(), planning.failed, planning.unfinished, planning.violating), (5, 2, 10, 0));
        assert_eq!(planning.over_budget(), Some(3));
        assert_eq!([0.0, 0.5, 0.75, 1.0].map(|share| planning.quantile_ms(share)), [1.0, 3.0, 4.0, 5.0]);
        assert_eq!(Planning::new(None).over_budget(), None);
    }

    fn estimate(model: DriverModel, entropy: f64) -> DriverEstimate {
        DriverEstimate {
            vehicle: "other".to_owned(),
            model,
            probabilities: [0.2; 5],
            safety_weight: 20.0,
            safety_weight_interval: [0.0, 100.0],
            entropy,
        }
    }

    #[test]
    fn a_belief_is_dated_from_the_last_change_of_the_driver_kind() {
        let mut beliefs = Beliefs::default();
        let kinds = [DriverModel::Nice, DriverModel::Nice, DriverModel::Tough, DriverModel::Tough];
        for (tick, kind) in kinds.into_iter().enumerate() {
            beliefs.observe(&[estimate(kind, tick as f64)], 0.1 * tick as f64);
        }
        beliefs.observe(&[], 0.4);
        let held: Vec<&HeldBelief> = beliefs.held().collect();
        assert_eq!(held, [&HeldBelief { estimate: estimate(DriverModel::Tough, 3.0), since_s: 0.2 }]);
    }
}
