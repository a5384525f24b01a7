//! Determines whether a run depends on the seed of its scenario.

use interplay_building::weather::Forecast;
use interplay_planners::PlanDeadline;

use crate::model::building::plant::BuildingPlant;
use crate::model::building::weather::WeatherSource;
use crate::model::scenario::{Scenario, Vehicle};
use crate::model::traffic::real_time::Deadline;

impl Scenario {
    /// Whether runs with different seeds may differ. If not, they are bit-identical.
    ///
    /// The seed decides the change of the starts, the vehicles of flows and the errors of sensors; and, in a building, the synthetic weather,
    /// errors of forecasts, and people.
    pub fn depends_on_seed(&self) -> bool {
        let jitter = self.start_jitter;
        let starts_vary = jitter.position_m > 0.0 || jitter.speed_mps > 0.0;
        let senses_errors = self.vehicles.len() > 1 && self.vehicles.iter().any(Vehicle::senses_errors);
        let vehicles_vary = (starts_vary && !self.vehicles.is_empty()) || self.flows.depend_on_seed;
        vehicles_vary || senses_errors || self.has_random_surroundings()
    }

    fn has_random_surroundings(&self) -> bool {
        let Some(building) = &self.building else { return false };
        let is_synthetic = matches!(self.weather, WeatherSource::Synthetic(_));
        let is_uncertain = matches!(self.weather.forecast(), Forecast::Uncertain { .. });
        // Another program may draw random numbers.
        let is_foreign = !matches!(building.plant, BuildingPlant::Network(_));
        is_synthetic || is_uncertain || is_foreign || self.occupancy.unwrap_or_default().depends_on_seed()
    }
}

impl Vehicle {
    fn senses_errors(&self) -> bool {
        self.sensing.is_some_and(|sensing| !sensing.is_exact() || sensing.drop_rate > 0.0)
    }
}

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
