//! The schedules of a scenario on the days of its run.

use interplay_building::calendar::CalendarError;
use interplay_building::network::NetworkError;
use interplay_building::schedule::{ScheduleError, Timetable};
use thiserror::Error;

use crate::model::scenario::Scenario;

/// The reasons why a scenario has no timetable. A loaded scenario has been checked for all of them.
#[derive(Debug, Error)]
pub enum TimetableError {
    /// A text is not a date.
    #[error(transparent)]
    Calendar(#[from] CalendarError),
    /// Schedules contradict one another, or do not fit the building.
    #[error(transparent)]
    Schedule(#[from] ScheduleError),
    /// Zones and walls do not form a network.
    #[error(transparent)]
    Network(#[from] NetworkError),
}

impl Scenario {
    /// The schedules of the zones by day; empty without a building.
    ///
    /// # Errors
    /// [`TimetableError`]; never for a loaded scenario.
    pub fn timetable(&self) -> Result<Timetable, TimetableError> {
        let Some(building) = &self.building else { return Ok(Timetable::default()) };
        let days = self.calendar.clone().unwrap_or_default().days(self.weather.first_weekday())?;
        let network = building.network()?;
        Ok(Timetable::new(&self.schedules, &network.names()[..network.zone_count()], days)?)
    }
}
