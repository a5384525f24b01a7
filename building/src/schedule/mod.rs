//! Schedules of zones by weekday: when people are in a zone, the wanted temperature at those times, and the heat that people bring.
//!
//! A zone that is named in a [`ZoneSchedule`] follows its schedules alone. A zone that is named in none follows the
//! common setpoints and the common occupancy.

mod timetable;
mod zone_schedule;

pub use timetable::{ScheduleError, Timetable};
pub use zone_schedule::{DayChoice, Period, ZoneSchedule};
