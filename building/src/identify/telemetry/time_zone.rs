//! Clocks of a place, by the name of its time zone.

use jiff::civil::DateTime;
use jiff::tz::{AmbiguousOffset, Offset, TimeZone, TimeZoneDatabase};

/// A time zone of the tz database, which is part of the program.
#[derive(Clone, Debug)]
pub(super) struct NamedZone(TimeZone);

impl NamedZone {
    /// The time zone of that name.
    pub fn find(name: &str) -> Option<Self> {
        TimeZoneDatabase::bundled().get(name).ok().map(Self)
    }

    /// The names of all time zones.
    pub fn names() -> Vec<String> {
        TimeZoneDatabase::bundled().available().map(|name| name.to_string()).collect()
    }

    /// By how much clocks of the place were ahead of Greenwich when they showed this \[s\]; `None` where they never did, since they were
    /// put forward. Of an hour that came twice it is the first, unless that was over `after_s` seconds (of UTC, since 1970).
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
pub(super) fn seconds_since_1970(shown: DateTime) -> f64 {
    shown.duration_since(DateTime::constant(1970, 1, 1, 0, 0, 0, 0)).as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_are_put_forward_and_back() {
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
