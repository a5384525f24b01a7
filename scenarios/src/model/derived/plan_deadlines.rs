//! The deadlines of plans.

use interplay_planners::PlanDeadline;

use crate::model::scenario::{Scenario, Vehicle};
use crate::model::traffic::real_time::Deadline;

impl Scenario {
    /// The time limit of a vehicle's plans, if the file states one \[ms\]. Driver models of people have none: people do
    /// not plan by a computer's clock.
    pub fn plan_budget_ms(&self, vehicle: &Vehicle) -> Option<f64> {
        let real_time = self.real_time.filter(|_| !vehicle.driver.goes_first())?;
        Some(real_time.plan_budget_ms.unwrap_or(1e3 * self.planning_period_s()))
    }

    /// The deadline of a vehicle's plans, if it is enforced.
    pub fn plan_deadline(&self, vehicle: &Vehicle) -> Option<PlanDeadline> {
        let is_enforced = self.real_time.is_some_and(|time| time.deadline == Deadline::Enforced);
        self.plan_budget_ms(vehicle).filter(|_| is_enforced).map(PlanDeadline::after_ms)
    }
}
