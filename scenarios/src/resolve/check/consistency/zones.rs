//! The check of zones, schedules and prices.

use interplay_building::energy::Tariff;
use interplay_building::network::Network;
use interplay_common::spelling::suggestion;

use super::checker::Checker;
use crate::format::read::tree::TomlNode;
use crate::model::building::weather::{EpwWeather, WeatherSource};
use crate::model::derived::timetable::TimetableError;
use crate::model::scenario::Scenario;
use crate::text::error::{Fault, quoted};

/// The faults of zones, schedules and prices.
pub(super) fn check(scenario: &Scenario, tree: &TomlNode, network: &Network) -> Vec<Fault> {
    let mut checker = Checker::new(scenario, tree);
    checker.calendar();
    checker.timetable();
    checker.energy();
    checker.sunlit_windows(network);
    checker.expected_zones(&network.names()[..network.zone_count()]);
    checker.faults
}

impl Checker<'_> {
    /// Whether the calendar and the weather file begin on the same day.
    fn calendar(&mut self) {
        let Some(calendar) = &self.scenario.calendar else { return };
        let WeatherSource::Epw(EpwWeather { stated: file, .. }) = &self.scenario.weather else { return };
        let Ok(Some((month, day))) = calendar.first_month_and_day() else { return };
        let stated =
            (file.month.is_some() || file.day.is_some()).then(|| (file.month.unwrap_or(1), file.day.unwrap_or(1)));
        if let Some((weather_month, weather_day)) = stated.filter(|stated| *stated != (month, day)) {
            let message = format!(
                "the calendar begins on day {day} of month {month}, and the weather on day {weather_day} of month \
                 {weather_month}"
            );
            let help = format!("state `month = {month}` and `day = {day}` in `[weather]`, or another `first_day`");
            self.refuse("calendar.first_day", "another day", message, &help);
        }
    }

    /// Whether schedules fit the zones, and the controller supports days that differ.
    fn timetable(&mut self) {
        let timetable = match self.scenario.timetable() {
            Ok(timetable) => timetable,
            Err(TimetableError::Calendar(error)) => {
                return self.refuse(&format!("calendar.{}", error.key), "here", error.to_string(), "");
            }
            Err(TimetableError::Schedule(error)) => {
                let path = format!("schedule.{}.{}", error.schedule, error.key);
                return self.refuse(&path, "here", error.to_string(), "");
            }
            Err(TimetableError::Network(_)) => return,
        };
        if let Some((key, why)) = self.scenario.controller().needs_equal_days().filter(|_| timetable.days_differ()) {
            let message = format!("`controller`: {why}, but schedules differ from one weekday to another");
            let help = "give the zones the same hours on all days, or state another controller or prediction";
            self.refuse(&format!("controller.{key}"), "needs equal days", message, help);
        }
    }

    /// Whether prices and coefficients of performance are valid.
    fn energy(&mut self) {
        let days = self.scenario.days();
        let check = |tariff: &Tariff| tariff.check().and_then(|()| tariff.check_days(days));
        if let Some(Err(error)) = self.scenario.tariff.as_ref().map(check) {
            let is_read = error.key.as_str() == "prices_per_kwh" && self.tree.at("tariff.file").is_some();
            let key = if is_read { "file" } else { error.key.as_str() };
            self.refuse(&format!("tariff.{key}"), "here", format!("`tariff`: {error}"), "");
        }
        if let Some(Err(error)) = self.scenario.heat_pump.as_ref().map(|heat_pump| heat_pump.check()) {
            let help = "write the points of a curve at rising outdoor temperatures";
            self.refuse(&format!("heat_pump.{}", error.key), "here", format!("`heat_pump`: {error}"), help);
        }
    }

    /// Whether the weather states the position of the sun, if windows need it.
    fn sunlit_windows(&mut self, network: &Network) {
        let WeatherSource::Csv(weather) = &self.scenario.weather else { return };
        if network.window_planes().is_empty() || weather.weather.sky.is_some() {
            return;
        }
        let message = "the building has windows, and the table of weather does not say where the sun stands".to_owned();
        let help = "state `latitude_deg`, `longitude_deg` and `time_zone_h` in `[weather]`, and `calendar.first_day` where the table \
                    has no dates";
        self.refuse("weather", "where is it?", message, help);
    }

    /// Whether expectations of zones are about zones that exist, and about money only where there are prices.
    fn expected_zones(&mut self, names: &[String]) {
        for (index, expected) in self.scenario.expect.zones.iter().enumerate() {
            let path = format!("expect.zone.{index}");
            if !names.contains(&expected.zone) {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let message = format!("there is no zone {}", quoted(&expected.zone));
                let help = suggestion(&expected.zone, "the zones are", &names);
                self.refuse(&format!("{path}.zone"), "unknown zone", message, &help);
            }
            if expected.bounds().iter().all(|(_, bound)| bound.is_none()) {
                let message = format!("`expect.zone` for {} expects nothing", quoted(&expected.zone));
                let [a, b, c, d] = expected.bounds().map(|(key, _)| key);
                self.refuse(&path, "no bound", message, &format!("state `{a}`, `{b}`, `{c}` or `{d}`"));
            }
            if expected.energy_cost_at_most.is_some() {
                self.priced(&format!("{path}.energy_cost_at_most"));
            }
        }
        let building = self.scenario.expect.building.unwrap_or_default();
        let bounds = [
            ("energy_cost_at_most", building.energy_cost_at_most),
            ("total_energy_cost_at_most", building.total_energy_cost_at_most),
        ];
        for (key, _) in bounds.iter().filter(|(_, bound)| bound.is_some()) {
            self.priced(&format!("expect.building.{key}"));
        }
    }

    fn priced(&mut self, path: &str) {
        if self.scenario.tariff.is_none() {
            let message = format!("{} is stated, but electricity has no price", quoted(path));
            self.refuse(path, "no price", message, "add a `[tariff]` with `prices_per_kwh`");
        }
    }
}
