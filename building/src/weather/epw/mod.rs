//! EPW files (EnergyPlus weather).
//!
//! A row's hour is the hour that *ends* then: hour 1 of the 1st of January ends at 01:00. Temperatures, humidity, pressure
//! and wind are those at the end of the interval; radiation is the sum over it. So row k (from zero) of an hourly file puts
//! its temperature at k + 1 hours after the first midnight, and its mean radiation at k + ½ hours. A file of a whole year
//! is cyclic: the temperature between 00:00 and 01:00 of the first day lies between the last row's and the first row's.
//!
//! Times are local standard time all year, as in the file; daylight saving in the header is ignored, and so are the years
//! and minutes of the rows (typical years mix years; hourly files write minute 0 or 60). A year is a leap year if the rows
//! have a 29th of February, whatever the header says. Missing values are bridged, and
//! counted in [`Epw::filled`]. Values are taken from no other column: a file without radiation has none.

mod calendar;
mod error;
mod field;
mod header;

use calendar::{Date, Stamp};
pub use error::{EpwError, EpwProblem};
pub use field::Field;
use field::{COLUMNS, FIELDS, Specification};
use header::Header;
pub use header::Location;

use super::{TimeSeries, Weather};
use crate::calendar::Weekday;

const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;

/// The content of an EPW file.
#[derive(Clone, Debug, PartialEq)]
pub struct Epw {
    /// Where the weather was measured.
    pub location: Location,
    /// Time between two rows \[s\].
    pub interval_s: f64,
    /// How many values of each field were missing and were bridged; fields without gaps are left out.
    pub filled: Vec<(Field, usize)>,
    first: Date,
    weekday: Option<Weekday>,
    leap: bool,
    whole_year: bool,
    /// Values of each field in the order of [`FIELDS`]; none if all are missing.
    columns: Vec<Option<Vec<f64>>>,
}

impl Epw {
    /// Reads the text of a file. (Old files are Latin-1: decode them lossily, other letters occur in names only.)
    ///
    /// # Errors
    /// [`EpwError`] with the line, if the text is no EPW file, is cut off, skips or repeats a row, or states something
    /// impossible.
    pub fn parse(text: &str) -> Result<Self, EpwError> {
        let header = Header::parse(text)?;
        let Rows { mut columns, leap } = Rows::parse(text, &header)?;
        let mut filled = Vec::new();
        let columns: Vec<Option<Vec<f64>>> = (FIELDS.iter().zip(&mut columns))
            .map(|(specification, values)| {
                let gaps = specification.fill.apply(values)?;
                if gaps > 0 {
                    filled.push((specification.field, gaps));
                }
                Some(std::mem::take(values))
            })
            .collect();
        let Some(rows) = columns[Field::DryBulb as usize].as_ref().map(Vec::len) else {
            return Err(EpwError { line: header.lines + 1, problem: EpwProblem::NoTemperature });
        };
        let days = if leap { 366 } else { 365 };
        Ok(Self {
            location: header.location,
            interval_s: HOUR_S / f64::from(header.intervals_per_hour),
            filled,
            first: header.first,
            weekday: header.weekday,
            leap,
            whole_year: rows == days * 24 * header.intervals_per_hour as usize,
            columns,
        })
    }

    /// The values of a field, a row each, with gaps bridged; none if all are missing.
    pub fn column(&self, field: Field) -> Option<&[f64]> {
        self.columns[field as usize].as_deref()
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns[Field::DryBulb as usize].as_ref().map_or(0, Vec::len)
    }

    /// Whether the rows have a 29th of February.
    pub fn is_leap(&self) -> bool {
        self.leap
    }

    /// Whether the rows cover a year, so that the weather goes on after the last with the first.
    pub fn is_whole_year(&self) -> bool {
        self.whole_year
    }

    /// Midnight at the start of a day, as time after that of the first day \[s\]; `None` if there is no such day.
    pub fn midnight_s(&self, month: u32, day: u32) -> Option<f64> {
        let date = Date::new(month, day).filter(|date| self.leap || *date != Date::FEBRUARY_29)?;
        let start_s = f64::from(date.days_after(self.first, self.leap)) * DAY_S;
        (start_s < self.rows() as f64 * self.interval_s).then_some(start_s)
    }

    /// The weekday of the day that begins at a midnight, as time after that of the first day \[s\]; `None` if the file states
    /// no weekday. (Typical years are put together from several, so it need not be that of the calendar.)
    pub fn weekday(&self, midnight_s: f64) -> Option<Weekday> {
        self.weekday.map(|first| first.after((midnight_s / DAY_S).round() as usize))
    }

    /// Temperature and sunshine as functions of time; without radiation in the file the sun does not shine.
    pub fn weather(&self) -> Weather {
        let series = |first_s: f64, values: Vec<f64>| TimeSeries {
            first_s,
            interval_s: self.interval_s,
            cyclic: self.whole_year,
            values,
        };
        let ambient_c = self.column(Field::DryBulb).unwrap_or_default().to_vec();
        let per_hour = HOUR_S / self.interval_s;
        let sun = self
            .column(Field::GlobalHorizontal)
            .map_or(vec![0.0], |sums| sums.iter().map(|sum| sum * per_hour).collect());
        Weather { ambient_c: series(self.interval_s, ambient_c), sun_w_per_m2: series(0.5 * self.interval_s, sun) }
    }
}

/// The values of all rows, with NaN for missing ones.
struct Rows {
    columns: [Vec<f64>; FIELDS.len()],
    leap: bool,
}

impl Rows {
    fn parse(text: &str, header: &Header) -> Result<Self, EpwError> {
        let end = Stamp::last(header.last, header.intervals_per_hour);
        let march = Stamp::first(Date::MARCH_1, header.intervals_per_hour);
        let mut rows = Self { columns: Default::default(), leap: false };
        let mut wanted = Stamp::first(header.first, header.intervals_per_hour);
        let mut last = None;
        let mut line = header.lines;
        for row in text.lines().skip(header.lines) {
            line += 1;
            if row.trim().is_empty() {
                continue;
            }
            let fail = |problem| EpwError { line, problem };
            if last == Some(end) {
                return Err(fail(EpwProblem::TooLong { end }));
            }
            let cells = cells(row).map_err(fail)?;
            let date = date(&cells).map_err(fail)?;
            if date == Date::FEBRUARY_29 {
                rows.leap = true;
                if wanted == march {
                    wanted = Stamp::first(date, header.intervals_per_hour);
                }
            }
            let found = Stamp { date, hour: whole(&cells, 3, "hour").map_err(fail)?, ..wanted };
            if found != wanted {
                return Err(fail(EpwProblem::OutOfOrder { found, wanted }));
            }
            for (values, specification) in rows.columns.iter_mut().zip(&FIELDS) {
                values.push(value(&cells, specification).map_err(fail)?);
            }
            last = Some(found);
            wanted = found.next(false);
        }
        if last == Some(end) {
            return Ok(rows);
        }
        let found = rows.columns[0].len();
        Err(EpwError { line, problem: EpwProblem::CutOff { found, wanted: end } })
    }
}

/// The columns that are needed.
fn cells(row: &str) -> Result<[&str; COLUMNS], EpwProblem> {
    let mut cells = [""; COLUMNS];
    let mut found = 0;
    for (cell, text) in cells.iter_mut().zip(row.split(',')) {
        *cell = text.trim();
        found += 1;
    }
    if found < COLUMNS { Err(EpwProblem::ShortRow { found, wanted: COLUMNS }) } else { Ok(cells) }
}

fn date(cells: &[&str; COLUMNS]) -> Result<Date, EpwProblem> {
    let (month, day) = (whole(cells, 1, "month")?, whole(cells, 2, "day")?);
    Date::new(month, day).ok_or_else(|| not_a_number(cells, 2, "day of the month"))
}

fn whole(cells: &[&str; COLUMNS], column: usize, field: &'static str) -> Result<u32, EpwProblem> {
    cells[column].parse().map_err(|_| not_a_number(cells, column, field))
}

/// A value, or NaN where it is missing.
fn value(cells: &[&str; COLUMNS], specification: &Specification) -> Result<f64, EpwProblem> {
    let &Specification { field, column, missing, least, greatest, .. } = specification;
    if cells[column].is_empty() {
        return Ok(f64::NAN);
    }
    let found: f64 = cells[column].parse().map_err(|_| not_a_number(cells, column, field.name()))?;
    if found >= missing {
        return Ok(f64::NAN);
    }
    if (least..=greatest).contains(&found) {
        return Ok(found);
    }
    Err(EpwProblem::Impossible { column: column + 1, field: field.name(), found, least, greatest, missing })
}

fn not_a_number(cells: &[&str; COLUMNS], column: usize, field: &'static str) -> EpwProblem {
    EpwProblem::NotANumber { column: column + 1, field, found: cells[column].to_owned() }
}
