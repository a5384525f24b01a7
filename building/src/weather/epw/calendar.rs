//! The calendar of a file, which determines the next row.
//!
//! Years are ignored, because typical years combine months of different years. 29 February exists if the rows contain it.

use std::fmt;

use jiff::ToSpan;
use jiff::civil::{self, date};

/// The year in which all days of the year are kept: a leap year, so that each of them exists.
const YEAR: i16 = 2000;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Date(civil::Date);

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
    pub(super) const FEBRUARY_29: Self = Self(date(YEAR, 2, 29));
    pub(super) const MARCH_1: Self = Self(date(YEAR, 3, 1));
    const JANUARY_1: Self = Self(date(YEAR, 1, 1));

    /// A day that exists in some year.
    pub(super) fn new(month: u32, day: u32) -> Option<Self> {
        civil::Date::new(YEAR, i8::try_from(month).ok()?, i8::try_from(day).ok()?).ok().map(Self)
    }

    /// A day as headers write it: `month/day`, `month/day/year` or `year/month/day` with a year of four digits that is not
    /// needed, `year-month-day`, or with the name of the month, as spreadsheets save it: `31-Dec`, `Dec 31`.
    pub(super) fn written(text: &str) -> Option<Self> {
        let parts: Vec<&str> =
            text.split(['/', '-', ' ', '.']).map(str::trim).filter(|part| !part.is_empty()).collect();
        let named = parts.iter().position(|part| month_named(part).is_some());
        if let Some(named) = named {
            let day = parts.iter().enumerate().find(|(place, part)| *place != named && part.len() <= 2)?.1;
            return Self::new(month_named(parts[named])?, day.parse().ok()?);
        }
        let numbers = parts.iter().map(|part| part.parse().ok()).collect::<Option<Vec<u32>>>()?;
        match (text.contains('/'), numbers.as_slice()) {
            (_, [1000..=9999, month, day]) | (true, [month, day] | [month, day, _]) => Self::new(*month, *day),
            _ => None,
        }
    }

    /// Month from 1, and day of the month.
    pub(super) fn month_and_day(self) -> (i8, i8) {
        (self.0.month(), self.0.day())
    }

    /// The day after, in a year with or without a 29th of February.
    pub(super) fn next(self, leap: bool) -> Self {
        match Self(self.0.saturating_add(1.day())) {
            Self::FEBRUARY_29 if !leap => Self::MARCH_1,
            Self(next) if next.year() != YEAR => Self::JANUARY_1,
            next => next,
        }
    }

    /// Days from another day to this one, going forwards.
    pub(super) fn days_after(self, other: Self, leap: bool) -> u32 {
        // In a year without 29 February, 1 March takes its place.
        let place = |Self(date): Self| match leap {
            true => date.day_of_year(),
            false => date.day_of_year_no_leap().unwrap_or(date.day_of_year()),
        };
        let days_of_year = if leap { 366 } else { 365 };
        (place(self) - place(other)).rem_euclid(days_of_year).unsigned_abs().into()
    }
}

/// The number of a month by its English name or the first three letters of it.
fn month_named(text: &str) -> Option<u32> {
    const MONTHS: [&str; 12] = [
        "january",
        "february",
        "march",
        "april",
        "may",
        "june",
        "july",
        "august",
        "september",
        "october",
        "november",
        "december",
    ];
    let text = text.to_ascii_lowercase();
    let found = MONTHS.iter().position(|name| text.len() >= 3 && name.starts_with(&text))?;
    u32::try_from(found + 1).ok()
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
        write!(f, "{}/{}", self.0.month(), self.0.day())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_day_visits_every_day_of_a_year() {
        for (leap, days) in [(false, 365), (true, 366)] {
            let first = Date::new(7, 15).expect("a day");
            let walk: Vec<Date> = std::iter::successors(Some(first), |date| Some(date.next(leap))).take(days).collect();
            for (index, date) in walk.iter().enumerate() {
                assert_eq!(date.days_after(first, leap) as usize, index, "{date}");
                assert_eq!(first.days_after(*date, leap) as usize, (days - index) % days, "{date}");
            }
            assert_eq!(walk[days - 1].next(leap), first, "the year is cyclic");
            assert_eq!(walk.contains(&Date::FEBRUARY_29), leap);
        }
    }

    #[test]
    fn dates_are_read_in_every_notation_of_epw_headers() {
        let day = |text: &str| Date::written(text).map(|date| date.to_string());
        for text in
            ["12/31", " 12/ 31", "12/31/2015", "2015/12/31", "2015-12-31", "31-Dec", "Dec 31", "31 december 2015"]
        {
            assert_eq!(day(text).as_deref(), Some("12/31"), "{text}");
        }
        for text in ["12-31", "31/12", "2015/12", "Dec", "31-Foo", "", "2015/13/1", "Dec-32"] {
            assert_eq!(day(text), None, "{text}");
        }
    }

    #[test]
    fn a_date_that_exists_in_no_year_is_refused() {
        for (month, day) in [(2, 30), (4, 31), (0, 1), (13, 1), (1, 0), (1, 32), (300, 1), (1, 300)] {
            assert_eq!(Date::new(month, day), None, "{month}/{day}");
        }
        assert_eq!(Date::new(2, 29).map(|date| date.to_string()).as_deref(), Some("2/29"));
    }
}
