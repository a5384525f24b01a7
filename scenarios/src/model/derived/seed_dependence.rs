//! Determines whether a run depends on the seed of its scenario.

use interplay_building::weather::Forecast;

use crate::model::building::plant::BuildingPlant;
use crate::model::building::weather::WeatherSource;
use crate::model::scenario::{Scenario, Vehicle};

impl Scenario {
    /// Whether runs with different seeds may differ. If not, they are bit-identical.
    ///
    /// The seed decides the change of the starts and the errors of sensors; and, in a building, the synthetic weather, errors of
    /// forecasts, and people.
    pub fn depends_on_seed(&self) -> bool {
        let jitter = self.start_jitter;
        let starts_vary = jitter.position_m > 0.0 || jitter.speed_mps > 0.0;
        let senses_errors = self.vehicles.len() > 1 && self.vehicles.iter().any(Vehicle::senses_errors);
        (starts_vary && !self.vehicles.is_empty()) || senses_errors || self.has_random_surroundings()
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
