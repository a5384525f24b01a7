//! The calendar of a file: which row comes next.
//!
//! Years are ignored, because typical years are put together from months of different ones. Whether the 29th of February
//! exists is read off the rows: it does when they have it.

use std::fmt;

/// Days of the months of a year without a 29th of February.
const DAYS: [u32; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

/// A day of the year.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Date {
    pub(super) month: u32,
    pub(super) day: u32,
}

/// The end of an interval, as a row states it: hour 1 ends at 01:00.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    pub(super) date: Date,
    /// 1 to 24.
    pub(super) hour: u32,
    /// Which interval of the hour, from one.
    pub(super) interval: u32,
    pub(super) intervals_per_hour: u32,
}

impl Date {
    /// A day that exists in some year.
    pub(super) fn new(month: u32, day: u32) -> Option<Self> {
        let days = *DAYS.get((month as usize).checked_sub(1)?)? + u32::from(month == 2);
        (1..=days).contains(&day).then_some(Self { month, day })
    }

    /// The day after, in a year with or without a 29th of February.
    fn next(self, leap: bool) -> Self {
        let days = DAYS[self.month as usize - 1] + u32::from(leap && self.month == 2);
        match (self.day < days, self.month < 12) {
            (true, _) => Self { day: self.day + 1, ..self },
            (false, true) => Self { month: self.month + 1, day: 1 },
            (false, false) => Self { month: 1, day: 1 },
        }
    }

    /// Days from another day to this one, going forwards.
    pub(super) fn days_after(self, other: Self, leap: bool) -> u32 {
        let mut date = other;
        let mut days = 0;
        while date != self && days < 366 {
            date = date.next(leap);
            days += 1;
        }
        days
    }
}

impl Stamp {
    /// The first interval of a day.
    pub(super) fn first(date: Date, intervals_per_hour: u32) -> Self {
        Self { date, hour: 1, interval: 1, intervals_per_hour }
    }

    /// The last interval of a day.
    pub(super) fn last(date: Date, intervals_per_hour: u32) -> Self {
        Self { date, hour: 24, interval: intervals_per_hour, intervals_per_hour }
    }

    /// The interval after; after the 28th of February it depends on the year.
    pub(super) fn next(self, leap: bool) -> Self {
        if self.interval < self.intervals_per_hour {
            return Self { interval: self.interval + 1, ..self };
        }
        if self.hour < 24 {
            return Self { hour: self.hour + 1, interval: 1, ..self };
        }
        Self::first(self.date.next(leap), self.intervals_per_hour)
    }
}

impl fmt::Display for Date {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.month, self.day)
    }
}

impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} hour {}", self.date, self.hour)?;
        if self.intervals_per_hour > 1 {
            write!(f, " interval {}", self.interval)?;
        }
        Ok(())
    }
}
