//! Determines whether a day of a run is a working day, a weekend day or a holiday.

use jiff::civil::{Date, Weekday as CivilWeekday};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use interplay_common::setting::SettingKey;

use crate::sun::days_since_2000;

/// The date of the first day, and the holidays.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Calendar {
    /// The date of the first day, year-month-day.
    #[schemars(example = &"2026-07-06", extend("x-excludes" = ["first_weekday"]))]
    pub first_day: Option<String>,
    /// The weekday of the first day, where no date is stated; by default that of the weather file, and without one a Monday.
    #[schemars(example = &"monday")]
    pub first_weekday: Option<Weekday>,
    /// Dates of days that are no working days, year-month-day; they need `first_day`.
    #[schemars(length(max = 1000))]
    pub holidays: Vec<String>,
}

/// A day of the week.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Weekday {
    /// The first working day.
    Monday,
    /// The second working day.
    Tuesday,
    /// The third working day.
    Wednesday,
    /// The fourth working day.
    Thursday,
    /// The fifth working day.
    Friday,
    /// The first day of the weekend.
    Saturday,
    /// The second day of the weekend.
    Sunday,
}

const WEEK: [Weekday; 7] = [
    Weekday::Monday,
    Weekday::Tuesday,
    Weekday::Wednesday,
    Weekday::Thursday,
    Weekday::Friday,
    Weekday::Saturday,
    Weekday::Sunday,
];

/// The kind of a day: its weekday, or a holiday.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DayKind {
    /// A weekday that is not a holiday.
    Plain(Weekday),
    /// A holiday.
    Holiday,
}

/// The kinds of the days of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunDays {
    first: Weekday,
    /// Numbers of the holidays, the first day being 0; sorted.
    holidays: Vec<usize>,
}

/// Why the date of a calendar cannot be used: it is unreadable or missing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problem}")]
pub struct CalendarError {
    /// The key at fault, in the table of the calendar.
    pub key: SettingKey,
    /// What is wrong.
    pub problem: String,
}

impl Weekday {
    /// The weekday `days` days later.
    #[must_use]
    pub fn after(self, days: usize) -> Self {
        WEEK[(self as usize + days) % WEEK.len()]
    }

    /// The weekday that an English word names, as weather files write it.
    pub fn named(word: &str) -> Option<Self> {
        let word = word.trim();
        WEEK.into_iter().find(|weekday| format!("{weekday:?}").eq_ignore_ascii_case(word))
    }

    /// The weekday of the day that begins at a midnight, given in days since noon of 1 January 2000, a Saturday.
    pub fn of_local_days(local_days: f64) -> Self {
        let since_monday = (local_days + 0.5).round() + 5.0;
        WEEK[since_monday.rem_euclid(WEEK.len() as f64) as usize]
    }

    fn from_date(date: Date) -> Self {
        let since_monday = CivilWeekday::Monday.until(date.weekday());
        WEEK[usize::from(since_monday.unsigned_abs()) % WEEK.len()]
    }
}

impl DayKind {
    /// Every kind of day: the week, and holidays.
    pub fn all() -> impl Iterator<Item = Self> {
        WEEK.into_iter().map(Self::Plain).chain([Self::Holiday])
    }

    /// Index of this kind in [`DayKind::all`].
    pub fn index(self) -> usize {
        match self {
            Self::Plain(weekday) => weekday as usize,
            Self::Holiday => WEEK.len(),
        }
    }
}

impl Default for RunDays {
    /// Days from a Monday on, without holidays.
    fn default() -> Self {
        Self { first: Weekday::Monday, holidays: Vec::new() }
    }
}

impl RunDays {
    /// The kind of day `day`, counted from zero.
    pub fn kind(&self, day: usize) -> DayKind {
        match self.holidays.binary_search(&day) {
            Ok(_) => DayKind::Holiday,
            Err(_) => DayKind::Plain(self.first.after(day)),
        }
    }
}

impl Calendar {
    /// The days of a run. `weather_weekday` is the weekday that a weather file states for the first day.
    ///
    /// # Errors
    /// [`CalendarError`] if a text is not a date, or a holiday is stated without the date of the first day.
    pub fn days(&self, weather_weekday: Option<Weekday>) -> Result<RunDays, CalendarError> {
        let first_day = self.first_date()?;
        let mut holidays = Vec::with_capacity(self.holidays.len());
        for (index, holiday) in self.holidays.iter().enumerate() {
            let key = SettingKey::from("holidays").entry(index);
            let date = date(holiday, &key)?;
            let Some(first_day) = first_day else {
                let problem = "`holidays` are dates, but the date of the first day is not stated: state `first_day`";
                return Err(CalendarError { key, problem: problem.to_owned() });
            };
            let days = first_day.until(date).map_or(-1, |span| span.get_days());
            holidays.extend(usize::try_from(days).ok());
        }
        holidays.sort_unstable();
        let first = first_day.map(Weekday::from_date).or(self.first_weekday).or(weather_weekday);
        Ok(RunDays { first: first.unwrap_or(Weekday::Monday), holidays })
    }

    /// Month and day of the first day, if a date is stated.
    ///
    /// # Errors
    /// [`CalendarError`] if the text is not a date.
    pub fn first_month_and_day(&self) -> Result<Option<(u32, u32)>, CalendarError> {
        let date = self.first_date()?;
        Ok(date.map(|date| (u32::from(date.month().unsigned_abs()), u32::from(date.day().unsigned_abs()))))
    }

    /// The date of the first day, if one is stated.
    ///
    /// # Errors
    /// [`CalendarError`] if the text is not a date.
    pub fn first_date(&self) -> Result<Option<Date>, CalendarError> {
        self.first_day.as_ref().map(|text| date(text, &SettingKey::from("first_day"))).transpose()
    }
}

/// The midnight at the start of a date, in days since noon of 1 January 2000, on local clocks.
pub fn local_days(date: Date) -> f64 {
    days_since_2000(i32::from(date.year()), date.month(), date.day())
}

/// The date that a text names.
fn date(text: &str, key: &SettingKey) -> Result<Date, CalendarError> {
    let digits = text.len() == 10 && text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-');
    let date = text.parse().ok().filter(|_| digits);
    let problem = || format!("`{key}` is `{text}`, which is not a date: write year-month-day, such as 2026-07-06");
    date.ok_or_else(|| CalendarError { key: key.clone(), problem: problem() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn calendar(first_day: Option<&str>, holidays: &[&str]) -> Calendar {
        let holidays = holidays.iter().map(|date| (*date).to_owned()).collect();
        Calendar { first_day: first_day.map(str::to_owned), first_weekday: None, holidays }
    }

    /// 2000-01-01 was a Saturday, and 2026-07-06 is a Monday.
    #[test]
    fn dates_have_the_weekdays_of_the_calendar() {
        let days = calendar(Some("2000-01-01"), &["2000-02-29", "1999-12-31"]).days(None).expect("dates");
        assert_eq!(days.kind(0), DayKind::Plain(Weekday::Saturday));
        assert_eq!(days.kind(2), DayKind::Plain(Weekday::Monday));
        assert_eq!(days.kind(59), DayKind::Holiday, "31 days of January, 28 of February before it");
        assert_eq!(days.kind(60), DayKind::Plain(Weekday::Wednesday), "2000-03-01");
        let days = calendar(Some("2026-07-06"), &["2027-07-06"]).days(None).expect("dates");
        assert_eq!(days.kind(0), DayKind::Plain(Weekday::Monday));
        assert_eq!(days.kind(365), DayKind::Holiday, "a year later");
    }

    #[test]
    fn days_since_2000_have_the_weekdays_of_their_dates() {
        for text in ["2000-01-01", "1999-12-31", "2026-07-06", "1961-04-12"] {
            let date: Date = text.parse().expect("a date");
            assert_eq!(Weekday::of_local_days(local_days(date)), Weekday::from_date(date), "{text}");
        }
    }

    #[test]
    fn without_a_date_the_weather_file_determines_the_weekday() {
        let days = calendar(None, &[]).days(Weekday::named(" SUNDAY ")).expect("no dates");
        assert_eq!([days.kind(0), days.kind(1)], [Weekday::Sunday, Weekday::Monday].map(DayKind::Plain));
        assert_eq!(calendar(None, &[]).days(None), Ok(RunDays::default()));
        assert_eq!(Weekday::named("Someday"), None);
    }

    #[test]
    fn a_text_that_is_not_a_date_is_refused() {
        for text in ["2026-02-30", "6.7.2026", "2026-7-6", "", "today", "2026-07-06T00:00"] {
            let error = calendar(Some(text), &[]).days(None).expect_err(text);
            assert_eq!(error.key.as_str(), "first_day");
        }
        let error = calendar(Some("2026-07-06"), &["2026-07-07", "x"]).days(None).expect_err("no date");
        assert_eq!(error.key.as_str(), "holidays.1");
        let error = calendar(None, &["2026-07-07"]).days(None).expect_err("no first day");
        assert!(error.to_string().contains("first_day"), "{error}");
    }
}
