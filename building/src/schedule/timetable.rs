//! The schedule of each zone on each day.

use interplay_common::setting::{self, SettingKey};
use interplay_common::spelling::suggestion;

use super::zone_schedule::ZoneSchedule;
use crate::calendar::{DayKind, RunDays};

/// How many kinds of days there are: a week, and holidays.
const DAY_KINDS: usize = 8;

/// The schedules of a building's zones, and the days on which they apply.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timetable {
    schedules: Vec<ZoneSchedule>,
    /// For each zone that follows schedules: which of them on each kind of day.
    zones: Vec<Option<[Option<usize>; DAY_KINDS]>>,
    days: RunDays,
}

/// Why schedules contradict one another, or do not fit a building.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{problem}")]
pub struct ScheduleError {
    /// Index of the schedule, from zero.
    pub schedule: usize,
    /// The key at fault, in the table of that schedule.
    pub key: SettingKey,
    /// What is wrong, and what would work.
    pub problem: String,
}

impl Timetable {
    /// The timetable of the zones with these names.
    ///
    /// # Errors
    /// [`ScheduleError`] if a zone is unknown or has two schedules for a day, if a period ends before it begins or overlaps
    /// another, or if a setting is out of range.
    pub fn new(schedules: &[ZoneSchedule], zone_names: &[String], days: RunDays) -> Result<Self, ScheduleError> {
        if let Err((schedule, error)) = setting::check_each(schedules) {
            return Err(ScheduleError { schedule, key: error.key.clone(), problem: error.to_string() });
        }
        let mut zones = vec![None; zone_names.len()];
        for (number, schedule) in schedules.iter().enumerate() {
            check_periods(number, schedule)?;
            for (place, name) in schedule.zones.iter().enumerate() {
                let key = SettingKey::from("zones").entry(place);
                let refused = |problem: String| ScheduleError { schedule: number, key: key.clone(), problem };
                let Some(zone) = zone_names.iter().position(|known| known == name) else {
                    let known: Vec<&str> = zone_names.iter().map(String::as_str).collect();
                    let which = suggestion(name, "the zones are", &known);
                    return Err(refused(format!("there is no zone `{name}`; {which}")));
                };
                let own = zones[zone].get_or_insert([None; DAY_KINDS]);
                for kind in DayKind::all().filter(|kind| schedule.applies_on(*kind)) {
                    if let Some(first) = own[kind.index()].replace(number) {
                        if first == number {
                            return Err(refused(format!("zone `{name}` is named twice: name it once")));
                        }
                        let day = match kind {
                            DayKind::Plain(weekday) => format!("{weekday:?}s"),
                            DayKind::Holiday => "holidays".to_owned(),
                        };
                        let problem = format!(
                            "zone `{name}` has two schedules for {day}, number {} and number {}: state other `days` in one",
                            first + 1,
                            number + 1
                        );
                        return Err(refused(problem));
                    }
                }
            }
        }
        Ok(Self { schedules: schedules.to_vec(), zones, days })
    }

    /// Whether no zone follows a schedule.
    pub fn is_empty(&self) -> bool {
        self.schedules.is_empty()
    }

    /// Whether the hours of a zone differ between kinds of days.
    pub fn days_differ(&self) -> bool {
        self.zones.iter().flatten().any(|own| own.iter().any(|schedule| schedule != &own[0]))
    }

    /// What a zone follows on a day, counted from zero: `None` if it follows no schedule at all, `Some(None)` if it has none
    /// for this day.
    pub(crate) fn look_up(&self, zone: usize, day: usize) -> Option<Option<&ZoneSchedule>> {
        let own = self.zones.get(zone)?.as_ref()?;
        Some(own[self.days.kind(day).index()].map(|number| &self.schedules[number]))
    }
}

fn check_periods(number: usize, schedule: &ZoneSchedule) -> Result<(), ScheduleError> {
    let refused = |index: usize, key: &str, problem: String| {
        let key = SettingKey::from("period").entry(index).key(key);
        Err(ScheduleError { schedule: number, key, problem })
    };
    for (index, period) in schedule.periods.iter().enumerate() {
        let (from_h, to_h) = (period.from_h, period.to_h);
        if to_h <= from_h {
            let problem = format!(
                "the period from {from_h} h to {to_h} h is empty: for a night write two, from {from_h} to 24 and from 0 to {to_h}"
            );
            return refused(index, "to_h", problem);
        }
        let overlapping = schedule.periods[..index].iter().find(|other| other.from_h < to_h && from_h < other.to_h);
        if let Some(other) = overlapping {
            let problem = format!(
                "the period from {from_h} h to {to_h} h overlaps that from {} h to {} h: let one begin where the other ends",
                other.from_h, other.to_h
            );
            return refused(index, "from_h", problem);
        }
    }
    Ok(())
}
