//! The forecasts that a plant in another program states about its own run.

use interplay_building::comfort::{Agenda, ComfortBounds};
use interplay_building::day::Surroundings;
use interplay_building::energy::Tariff;
use interplay_building::occupancy::ZoneRecord;
use interplay_building::weather::Weather;

/// Weather, people, comfort bounds and prices of a whole run, which replace those of the scenario.
#[derive(Clone, Debug)]
pub struct Foreseen {
    /// The weather from the first midnight on.
    pub weather: Weather,
    /// Heat of people and machines, for the zones with known values.
    pub people: Vec<ZoneRecord>,
    /// Comfort bounds; none keeps the scenario's targets.
    pub bounds: Option<ComfortBounds>,
    /// Prices of electricity; none keeps the scenario's.
    pub tariff: Option<Tariff>,
}

impl Foreseen {
    /// Replaces the weather and people of the scenario.
    #[must_use]
    pub fn around(&self, surroundings: Surroundings) -> Surroundings {
        let mut surroundings = Surroundings { weather: self.weather.clone(), ..surroundings };
        let known = |zone: usize| self.people.iter().any(|record| record.zone == zone);
        surroundings.recorded.zones.retain(|record| !known(record.zone));
        surroundings.recorded.zones.extend(self.people.iter().cloned());
        surroundings
    }

    /// Replaces the targets and prices of the scenario.
    #[must_use]
    pub fn wanted(&self, agenda: Agenda) -> Agenda {
        let agenda = match &self.bounds {
            Some(bounds) => agenda.bounded(bounds.clone()),
            None => agenda,
        };
        match &self.tariff {
            Some(tariff) => agenda.priced(tariff.clone()),
            None => agenda,
        }
    }
}
