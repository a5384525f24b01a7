//! Schedules of zones: when people are in a zone, how warm it shall then be, and how much heat they bring, by weekday.
//!
//! A zone that is named in a [`ZoneSchedule`] follows its schedules alone. A zone that is named in none follows the
//! common setpoints and the common occupancy.

mod timetable;
mod zone_schedule;

pub use timetable::{ScheduleError, Timetable};
pub use zone_schedule::{DayChoice, Period, ZoneSchedule};
