//! The time of a row of a table of series.

use jiff::civil::{Date, Time};

use super::clock::{ClockTime, parsed};

/// Patterns of dates with a time that are understood; `%z` is an offset from UTC.
const PATTERNS: [&str; 10] = [
    "%Y-%m-%dT%H:%M:%S%z",
    "%Y-%m-%dT%H:%M%z",
    "%Y-%m-%d %H:%M:%S%z",
    "%Y-%m-%d %H:%M%z",
    "%Y-%m-%dT%H:%M:%S",
    "%Y-%m-%dT%H:%M",
    "%Y-%m-%d %H:%M:%S",
    "%Y-%m-%d %H:%M",
    "%d.%m.%Y %H:%M:%S",
    "%d.%m.%Y %H:%M",
];

/// How the times of a table are written, by the title of their column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TimeForm {
    /// Hours or seconds since the first midnight, by the length of one \[s\].
    Elapsed(f64),
    /// Dates with a time.
    Calendar,
}

/// A moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RowTime {
    /// Since some midnight that is the same for all rows \[s\].
    pub elapsed_s: f64,
    /// The day on the clocks of the row, and the time since its midnight \[s\].
    pub local: Option<(Date, f64)>,
}

impl TimeForm {
    /// The form of time that the title of a column announces.
    pub fn of(title: &str) -> Self {
        match title.to_ascii_lowercase().as_str() {
            "hour" | "hours" | "hour_h" | "time_h" => Self::Elapsed(3600.0),
            "time_s" | "seconds" => Self::Elapsed(1.0),
            _ => Self::Calendar,
        }
    }

    /// The expected form of the times, in words.
    pub fn wanted(self) -> &'static str {
        match self {
            Self::Elapsed(3600.0) => "hours since the first midnight, as in 0.25",
            Self::Elapsed(_) => "seconds since the first midnight, as in 900",
            Self::Calendar => {
                "a date with a time, as in 2026-07-06 00:15 or 2026-07-06T00:15+02:00; numbers of hours stand in a column `hour`, of seconds in `time_s`"
            }
        }
    }

    /// The time that a cell states.
    pub fn read(self, text: &str) -> Option<RowTime> {
        match self {
            Self::Elapsed(unit_s) => {
                let number = text.parse::<f64>().ok().filter(|number| number.is_finite())?;
                Some(RowTime { elapsed_s: number * unit_s, local: None })
            }
            Self::Calendar => calendar(text),
        }
    }
}

fn calendar(text: &str) -> Option<RowTime> {
    let parsed = PATTERNS.iter().find_map(|pattern| parsed(pattern, text))?;
    let here = parsed.to_datetime().ok()?;
    let since_midnight = here.duration_since(here.date().to_datetime(Time::midnight()));
    let local = Some((here.date(), since_midnight.as_secs_f64()));
    Some(RowTime { elapsed_s: ClockTime::stated(&parsed)?.elapsed_s, local })
}
