//! The rows after the header: their times follow one another, and their cells are numbers or marked as missing.

use super::calendar::{Date, Stamp};
use super::error::{EpwError, EpwProblem};
use super::field::{COLUMNS, FIELDS, Field, Specification};
use super::header::Header;

/// The values of all rows, with NaN for missing ones.
pub(super) struct Rows {
    /// In the order of [`FIELDS`].
    pub columns: [Vec<f64>; FIELDS.len()],
    pub leap: bool,
    pub doubts: Vec<Doubt>,
    /// The line of each row, from one.
    pub lines: Vec<usize>,
    /// The year of each day's first row; none where it is no year.
    pub years: Vec<Option<i16>>,
}

/// A cell that holds no number, or an impossible one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Doubt {
    /// The row, from zero.
    pub row: usize,
    pub field: Field,
    pub problem: EpwProblem,
}

impl Rows {
    pub fn parse(text: &str, header: &Header) -> Result<Self, EpwError> {
        let end = Stamp::last(header.last, header.intervals_per_hour);
        let march = Stamp::first(Date::MARCH_1, header.intervals_per_hour);
        let mut rows =
            Self { columns: Default::default(), leap: false, doubts: Vec::new(), lines: Vec::new(), years: Vec::new() };
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
            rows.push(&cells, line, found == Stamp::first(date, header.intervals_per_hour));
            last = Some(found);
            wanted = found.next(false);
        }
        if last == Some(end) {
            return Ok(rows);
        }
        let found = rows.lines.len();
        Err(EpwError { line, problem: EpwProblem::CutOff { found, wanted: end } })
    }

    /// Appends a row whose time is right.
    fn push(&mut self, cells: &[&str; COLUMNS], line: usize, begins_day: bool) {
        let row = self.lines.len();
        self.lines.push(line);
        if begins_day {
            self.years.push(cells[0].parse().ok().filter(|year| (1800..=2300).contains(year)));
        }
        for (values, specification) in self.columns.iter_mut().zip(&FIELDS) {
            values.push(value(cells, specification).unwrap_or_else(|problem| {
                self.doubts.push(Doubt { row, field: specification.field, problem });
                f64::NAN
            }));
        }
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
