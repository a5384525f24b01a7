//! What a plant that is another program knows beforehand of its own run.

use interplay_building::comfort::{Agenda, ComfortBounds};
use interplay_building::day::Surroundings;
use interplay_building::energy::Tariff;
use interplay_building::occupancy::ZoneRecord;
use interplay_building::weather::Weather;

/// Weather, people, bounds of comfort and prices of a whole run, which take the place of those of the scenario.
#[derive(Clone, Debug)]
pub struct Foreseen {
    /// The weather from the first midnight on.
    pub weather: Weather,
    /// Heat of people and machines, for the zones of which it is known.
    pub people: Vec<ZoneRecord>,
    /// Bounds of comfort; none leaves the wanted temperatures as they are.
    pub bounds: Option<ComfortBounds>,
    /// Prices of electricity; none leaves them as they are.
    pub tariff: Option<Tariff>,
}

impl Foreseen {
    /// Puts itself in the place of weather and people.
    #[must_use]
    pub fn around(&self, surroundings: Surroundings) -> Surroundings {
        let mut surroundings = Surroundings { weather: self.weather.clone(), ..surroundings };
        let known = |zone: usize| self.people.iter().any(|record| record.zone == zone);
        surroundings.recorded.zones.retain(|record| !known(record.zone));
        surroundings.recorded.zones.extend(self.people.iter().cloned());
        surroundings
    }

    /// Puts itself in the place of wanted temperatures and prices.
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
