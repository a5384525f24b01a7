//! Dates and times as tables write them, and the clocks of a time zone.

use jiff::civil::{Date, DateTime, Time};
use jiff::fmt::strtime::BrokenDownTime;
use jiff::tz::{AmbiguousOffset, Offset, TimeZone, TimeZoneDatabase};

/// Seconds since 1970, and by how much the clocks that showed the time were ahead of UTC; both in UTC if no offset is known.
#[derive(Clone, Copy)]
pub(crate) struct ClockTime {
    pub elapsed_s: f64,
    pub offset_s: f64,
}

impl ClockTime {
    /// The time that a text states, with its offset from UTC, if stated.
    pub fn stated(parsed: &BrokenDownTime) -> Option<Self> {
        let offset_s = parsed.offset().map_or(0.0, |offset| f64::from(offset.seconds()));
        Some(Self { elapsed_s: seconds_since_1970(parsed.to_datetime().ok()?) - offset_s, offset_s })
    }
}

/// An offset from UTC in a format.
pub(crate) const OFFSET: &str = "%z";

/// The parts of a time of this format. `%z` reads offsets with and without a colon, and `Z`.
pub(crate) fn parsed(format: &str, text: &str) -> Option<BrokenDownTime> {
    let at_greenwich =
        text.strip_suffix('Z').filter(|_| format.ends_with(OFFSET)).map(|local| format!("{local}+00:00"));
    let text = at_greenwich.as_deref().unwrap_or(text);
    BrokenDownTime::parse(format, text).or_else(|_| BrokenDownTime::parse(format.replace(OFFSET, "%:z"), text)).ok()
}

/// The format that reads the time, where the stated one lacks but the offset from UTC at its end.
pub(crate) fn format_with_offset(format: &str, text: &str) -> Option<String> {
    if format.contains(OFFSET) {
        return None;
    }
    [format!("{format}{OFFSET}"), format!("{format} {OFFSET}")]
        .into_iter()
        .find(|format| parsed(format, text).is_some())
}

/// A time zone of the tz database, which is part of the program.
#[derive(Clone, Debug)]
pub(crate) struct NamedZone(TimeZone);

impl NamedZone {
    /// The time zone of that name.
    pub fn find(name: &str) -> Option<Self> {
        TimeZoneDatabase::bundled().get(name).ok().map(Self)
    }

    /// The names of all time zones.
    pub fn names() -> Vec<String> {
        TimeZoneDatabase::bundled().available().map(|name| name.to_string()).collect()
    }

    /// The offset of the zone's clocks from UTC when they showed this time \[s\]; `None` if they skipped it when they were put forward.
    /// For an hour that occurs twice, the first occurrence is taken, unless it is before `after_s` (seconds of UTC since 1970).
    pub fn offset_s(&self, shown: DateTime, after_s: Option<f64>) -> Option<f64> {
        let seconds = |offset: Offset| f64::from(offset.seconds());
        match self.0.to_ambiguous_timestamp(shown).offset() {
            AmbiguousOffset::Unambiguous { offset } => Some(seconds(offset)),
            AmbiguousOffset::Gap { .. } => None,
            AmbiguousOffset::Fold { before, after } => {
                let first_s = seconds_since_1970(shown) - seconds(before);
                let is_over = after_s.is_some_and(|after_s| first_s <= after_s);
                Some(seconds(if is_over { after } else { before }))
            }
        }
    }
}

/// Seconds on the same clocks since the start of 1970.
pub(crate) fn seconds_since_1970(shown: DateTime) -> f64 {
    shown.duration_since(DateTime::constant(1970, 1, 1, 0, 0, 0, 0)).as_secs_f64()
}

/// Patterns of dates with a time that are understood; `%z` is an offset from UTC.
const PATTERNS: [&str; 11] = [
    "%Y-%m-%dT%H:%M:%S%.f%z",
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
    /// Whether the text states an offset from UTC, or counts from 1970: then no change of the clocks disturbs it.
    pub is_absolute: bool,
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
                "a date with a time, as in 2026-07-06 00:15 or 2026-07-06T00:15+02:00, or seconds since 1970; numbers of hours stand in a column `hour`, of seconds in `time_s`"
            }
        }
    }

    /// The time that a cell states.
    pub fn read(self, text: &str) -> Option<RowTime> {
        match self {
            Self::Elapsed(unit_s) => {
                let number = text.parse::<f64>().ok().filter(|number| number.is_finite())?;
                Some(RowTime { elapsed_s: number * unit_s, local: None, is_absolute: true })
            }
            Self::Calendar => calendar(text),
        }
    }
}

/// Numbers in this range are seconds since 1970, from 1973 to 2286; a thousand times larger ones are milliseconds.
const SECONDS_SINCE_1970: std::ops::Range<f64> = 1e8..1e10;

/// A time since 1970, on the clocks of UTC.
fn since_1970(text: &str) -> Option<RowTime> {
    let number: f64 = text.parse().ok()?;
    let elapsed_s = [number, 1e-3 * number].into_iter().find(|seconds| SECONDS_SINCE_1970.contains(seconds))?;
    let days = (elapsed_s / 86_400.0).floor();
    let date = Date::constant(1970, 1, 1).checked_add(jiff::Span::new().days(days as i64)).ok()?;
    Some(RowTime { elapsed_s, local: Some((date, elapsed_s - 86_400.0 * days)), is_absolute: true })
}

fn calendar(text: &str) -> Option<RowTime> {
    if let Some(time) = since_1970(text) {
        return Some(time);
    }
    let parsed = PATTERNS.iter().find_map(|pattern| parsed(pattern, text))?;
    let here = parsed.to_datetime().ok()?;
    let since_midnight = here.duration_since(here.date().to_datetime(Time::midnight()));
    let local = Some((here.date(), since_midnight.as_secs_f64()));
    Some(RowTime { elapsed_s: ClockTime::stated(&parsed)?.elapsed_s, local, is_absolute: parsed.offset().is_some() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORMAT: &str = "%Y-%m-%dT%H:%M:%S%z";

    #[test]
    fn utc_offsets_are_read_in_three_notations() {
        for (offset, seconds) in [("Z", 0), ("+0200", 7200), ("+02:00", 7200), ("-05:30", -19_800)] {
            let time = parsed(FORMAT, &format!("2026-07-06T00:15:00{offset}")).expect("a time");
            assert_eq!(time.offset().map(|offset| offset.seconds()), Some(seconds), "{offset}");
        }
        assert!(parsed(FORMAT, "2026-07-06T00:15:00").is_none());
    }

    #[test]
    fn a_time_format_that_lacks_only_the_offset_is_suggested() {
        let found = |text| format_with_offset("%Y-%m-%d %H:%M", text);
        assert_eq!(found("2026-07-06 00:15Z").as_deref(), Some("%Y-%m-%d %H:%M%z"));
        assert_eq!(found("2026-07-06 00:15 +0200").as_deref(), Some("%Y-%m-%d %H:%M %z"));
        assert_eq!(found("6.7.2026 00:15Z"), None);
        assert_eq!(format_with_offset(FORMAT, "2026-07-06T00:15:00+02:00"), None);
    }

    #[test]
    fn offsets_of_a_time_zone_are_correct_around_clock_changes() {
        let zurich = NamedZone::find("Europe/Zurich").expect("a zone");
        let at = |month: i8, day: i8, hour: i8| DateTime::constant(2026, month, day, hour, 30, 0, 0);
        assert_eq!(zurich.offset_s(at(1, 1, 12), None), Some(3600.0));
        assert_eq!(zurich.offset_s(at(7, 1, 12), None), Some(7200.0));
        assert_eq!(zurich.offset_s(at(3, 29, 2), None), None, "put forward from 2 to 3");
        let first_s = seconds_since_1970(at(10, 25, 2)) - 7200.0;
        assert_eq!(zurich.offset_s(at(10, 25, 2), Some(first_s - 900.0)), Some(7200.0), "half past two, summer time");
        assert_eq!(zurich.offset_s(at(10, 25, 2), Some(first_s)), Some(3600.0), "half past two once more");
        assert!(NamedZone::find("Europe/Zurch").is_none());
        assert!(NamedZone::names().iter().any(|name| name == "Asia/Kolkata"));
    }
}
