//! Schedules of zones by weekday: when people are in a zone, the wanted temperature at those times, and the heat that people bring.
//!
//! A zone that is named in a [`ZoneSchedule`] follows its schedules alone. A zone that is named in none follows the
//! common setpoints and the common occupancy.

use interplay_common::setting::{self, SettingKey};
use interplay_common::spelling::suggestion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::calendar::{DayKind, RunDays, Weekday};

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

/// When a period begins or ends may be missed by this much, so that rounding moves no step \[h\].
const ROUNDING_H: f64 = 1e-9;

/// Wanted temperatures and people of some zones on some days. What it does not state is as in `[setpoints]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZoneSchedule {
    /// The names of the zones that follow it. On days for which a zone has no schedule it is unoccupied.
    #[schemars(length(min = 1, max = 1000), example = vec!["office"])]
    pub zones: Vec<String>,
    /// The days on which it applies. A holiday is none of its weekdays.
    #[serde(default = "everyday")]
    #[schemars(length(min = 1, max = 11))]
    pub days: Vec<DayChoice>,
    /// Wanted temperature outside of the periods, with `other_weight` of `[setpoints]`; without it the temperature is then
    /// free \[°C\].
    #[serde(default)]
    #[schemars(range(min = -50.0, max = 100.0), example = 17.0)]
    pub other_c: Option<f64>,
    /// Heat of machines at all times \[kW\].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub base_kw: f64,
    /// When people are there, one `[[schedule.period]]` each; none on an empty day.
    #[serde(rename = "period", default)]
    #[schemars(length(max = 48), example = json!([{ "from_h": 8.0, "to_h": 18.0, "wanted_c": 21.0 }]))]
    pub periods: Vec<Period>,
}

fn everyday() -> Vec<DayChoice> {
    vec![DayChoice::Everyday]
}

/// Hours of a day during which a zone is occupied.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Period {
    /// Hour of the day at which the period begins \[h\].
    #[schemars(range(min = 0.0, max = 24.0), example = 8.0)]
    pub from_h: f64,
    /// Hour of the day at which the period ends; a night is two periods, up to 24 and from 0 \[h\].
    #[schemars(range(min = 0.0, max = 24.0), example = 18.0)]
    pub to_h: f64,
    /// Wanted temperature \[°C\].
    #[schemars(range(min = -50.0, max = 100.0), example = 21.0)]
    pub wanted_c: f64,
    /// Deviations up to this are comfortable; that of `[setpoints]` if it is left out \[K\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 1.0)]
    pub band_k: Option<f64>,
    /// Heat of people and what they switch on \[kW\].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub people_kw: f64,
}

/// The days on which a schedule applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DayChoice {
    /// All days, holidays too.
    Everyday,
    /// Monday to Friday, but no holiday.
    Workday,
    /// Saturday and Sunday, but no holiday.
    Weekend,
    /// Holidays.
    Holiday,
    /// Mondays that are no holiday.
    Monday,
    /// Tuesdays that are no holiday.
    Tuesday,
    /// Wednesdays that are no holiday.
    Wednesday,
    /// Thursdays that are no holiday.
    Thursday,
    /// Fridays that are no holiday.
    Friday,
    /// Saturdays that are no holiday.
    Saturday,
    /// Sundays that are no holiday.
    Sunday,
}

impl DayChoice {
    /// Whether the choice includes days of this kind.
    pub(crate) fn includes(self, kind: DayKind) -> bool {
        let DayKind::Plain(weekday) = kind else { return matches!(self, Self::Everyday | Self::Holiday) };
        let is_weekend = matches!(weekday, Weekday::Saturday | Weekday::Sunday);
        match self {
            Self::Everyday => true,
            Self::Workday => !is_weekend,
            Self::Weekend => is_weekend,
            Self::Holiday => false,
            Self::Monday => weekday == Weekday::Monday,
            Self::Tuesday => weekday == Weekday::Tuesday,
            Self::Wednesday => weekday == Weekday::Wednesday,
            Self::Thursday => weekday == Weekday::Thursday,
            Self::Friday => weekday == Weekday::Friday,
            Self::Saturday => weekday == Weekday::Saturday,
            Self::Sunday => weekday == Weekday::Sunday,
        }
    }
}

impl ZoneSchedule {
    /// Whether the schedule applies on days of this kind.
    pub(crate) fn applies_on(&self, kind: DayKind) -> bool {
        self.days.iter().any(|days| days.includes(kind))
    }

    /// The period of an hour; both ends belong to it, and to the earlier one where two meet.
    pub(crate) fn period_at(&self, hour: f64) -> Option<&Period> {
        let holds = |period: &&Period| period.from_h - ROUNDING_H <= hour && hour <= period.to_h + ROUNDING_H;
        self.periods.iter().filter(holds).min_by(|a, b| a.from_h.total_cmp(&b.from_h))
    }

    /// Heat of people at an hour \[kW\], for people who come and go later by these times \[h\].
    pub fn people_kw(&self, hour: f64, comes_later_h: f64, goes_later_h: f64) -> f64 {
        let there = |period: &&Period| (period.from_h + comes_later_h..period.to_h + goes_later_h).contains(&hour);
        self.periods.iter().filter(there).map(|period| period.people_kw).fold(0.0, f64::max)
    }
}
