//! The eight lines before the rows, of which two matter.

use std::fmt;

use interplay_common::cell::shown_cell;

use super::calendar::Date;
use crate::calendar::Weekday;

/// Where the weather was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Location {
    /// City, as the file writes it.
    pub city: String,
    /// Country, as the file writes it.
    pub country: String,
    /// Where the data come from, as the file writes it.
    pub source: String,
    /// Latitude, positive to the north \[°\].
    pub latitude_deg: f64,
    /// Longitude, positive to the east \[°\].
    pub longitude_deg: f64,
    /// Time zone, hours ahead of Greenwich \[h\].
    pub time_zone_h: f64,
    /// Elevation above the sea \[m\].
    pub elevation_m: f64,
}

/// What the header says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    pub(super) location: Location,
    pub(super) first: Date,
    pub(super) last: Date,
    /// The weekday of the first day, if the file states one.
    pub(super) weekday: Option<Weekday>,
    pub(super) intervals_per_hour: u32,
    pub(super) lines: usize,
}

/// A line of the header, split at its commas.
struct Fields<'a> {
    line: usize,
    fields: Vec<&'a str>,
}

impl Header {
    pub(super) fn parse(text: &str) -> Result<Self, EpwError> {
        const WANTED: &str = "DATA PERIODS";
        let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
        let (_, first_line) = lines.next().unwrap_or((1, ""));
        if !begins(first_line, "LOCATION") {
            return Err(EpwError::malformed(1, "an EPW file begins with `LOCATION,`, and this does not"));
        }
        let location = location(&Fields::of(1, first_line))?;
        // Only header lines begin with a letter, so the periods are never looked for among the rows.
        let header = lines.take_while(|(_, line)| !line.starts_with(|c: char| c.is_ascii_digit()));
        let mut seen = 1;
        for (line, text) in header {
            if begins(text, WANTED) {
                return Self::with_period(location, &Fields::of(line, text));
            }
            seen = line;
        }
        Err(EpwError::malformed(seen + 1, format!("the file ends before its `{WANTED}` line")))
    }

    /// `DATA PERIODS, periods, intervals per hour, name, weekday, first day, last day`.
    fn with_period(location: Location, fields: &Fields<'_>) -> Result<Self, EpwError> {
        let periods = fields.number(1, "the number of data periods", "1")?;
        if periods != 1.0 {
            return Err(fields.wrong(1, "the number of data periods", "1: split the file into one for each period"));
        }
        let wanted = "a divisor of 60, 1 for hourly data";
        let intervals = fields.number(2, "the number of intervals an hour", wanted)?;
        if !(1.0..=60.0).contains(&intervals) || 60.0 % intervals != 0.0 {
            return Err(fields.wrong(2, "the number of intervals an hour", wanted));
        }
        Ok(Self {
            location,
            first: fields.date(5, "the first day of the data period")?,
            last: fields.date(6, "the last day of the data period")?,
            weekday: Weekday::named(fields.text(4)),
            intervals_per_hour: intervals as u32,
            lines: fields.line,
        })
    }
}

/// `LOCATION, city, region, country, source, station, latitude, longitude, time zone, elevation`.
fn location(fields: &Fields<'_>) -> Result<Location, EpwError> {
    Ok(Location {
        city: fields.text(1).to_owned(),
        country: fields.text(3).to_owned(),
        source: fields.text(4).to_owned(),
        latitude_deg: fields.number(6, "the latitude", "degrees north")?,
        longitude_deg: fields.number(7, "the longitude", "degrees east")?,
        time_zone_h: fields.number(8, "the time zone", "hours ahead of Greenwich")?,
        elevation_m: fields.number(9, "the elevation", "metres above the sea")?,
    })
}

fn begins(line: &str, keyword: &str) -> bool {
    let line = line.trim_start_matches('\u{feff}');
    line.split(',').next().is_some_and(|first| first.trim().eq_ignore_ascii_case(keyword))
}

impl<'a> Fields<'a> {
    fn of(line: usize, text: &'a str) -> Self {
        Self { line, fields: text.split(',').map(str::trim).collect() }
    }

    fn text(&self, index: usize) -> &'a str {
        self.fields.get(index).copied().unwrap_or("")
    }

    fn wrong(&self, index: usize, field: &str, wanted: &str) -> EpwError {
        EpwError::malformed(self.line, format!("{field} is {}; it should be {wanted}", shown_cell(self.text(index))))
    }

    fn number(&self, index: usize, field: &str, wanted: &str) -> Result<f64, EpwError> {
        let number: Option<f64> = self.text(index).parse().ok();
        number.filter(|number| number.is_finite()).ok_or_else(|| self.wrong(index, field, wanted))
    }

    fn date(&self, index: usize, field: &str) -> Result<Date, EpwError> {
        Date::written(self.text(index))
            .ok_or_else(|| self.wrong(index, field, "month/day, as in 12/31, or year/month/day, or 31-Dec"))
    }
}

/// Why an EPW file is refused: it is incomplete, or lacks what a run uses.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct EpwError {
    /// The line, from one.
    pub line: usize,
    /// What is wrong with it.
    pub problem: EpwProblem,
}

/// What is wrong with a line of an EPW file, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EpwProblem {
    /// A line, row or cell cannot be read, or does not follow the one before.
    Malformed(String),
    /// A field that is used has no values at all.
    NoValues(String),
    /// A field that is used is missing for longer than may be bridged.
    Gap(String),
}

impl fmt::Display for EpwProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Malformed(words) | Self::NoValues(words) | Self::Gap(words)) = self;
        f.write_str(words)
    }
}

impl EpwError {
    /// A line that cannot be read.
    pub(super) fn malformed(line: usize, words: impl Into<String>) -> Self {
        Self { line, problem: EpwProblem::Malformed(words.into()) }
    }
}
