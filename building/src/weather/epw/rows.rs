//! The rows after the header: their times follow one another, and their cells are numbers or marked as missing.

use interplay_common::cell::shown_cell;

use super::calendar::{Date, Stamp};
use super::header::{EpwError, Header};

/// The values of all rows, with NaN for missing ones.
pub(super) struct Rows {
    /// In the order of [`FIELDS`].
    pub columns: [Vec<f64>; FIELDS.len()],
    pub leap: bool,
    pub doubts: Vec<Doubt>,
    pub lines: Vec<usize>,
    /// The year of each day's first row; none if that is not a year.
    pub years: Vec<Option<i16>>,
}

/// A cell that holds an impossible value, or a text that is not a number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Doubt {
    /// The row, from zero.
    pub row: usize,
    pub field: Field,
    pub problem: String,
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
            let fail = |words: String| EpwError::malformed(line, words);
            if last == Some(end) {
                return Err(fail(format!("a row after {end}, where the data end according to the header")));
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
                let words =
                    format!("this is {found}, but {wanted} comes next: rows are missing, repeated or out of order");
                return Err(fail(words));
            }
            rows.push(&cells, line, found == Stamp::first(date, header.intervals_per_hour));
            last = Some(found);
            wanted = found.next(false);
        }
        if last == Some(end) {
            return Ok(rows);
        }
        let words = format!("the file ends here, with {} rows; its header promises data up to {end}", rows.lines.len());
        Err(EpwError::malformed(line, words))
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
fn cells(row: &str) -> Result<[&str; COLUMNS], String> {
    let mut cells = [""; COLUMNS];
    let mut found = 0;
    for (cell, text) in cells.iter_mut().zip(row.split(',')) {
        *cell = text.trim();
        found += 1;
    }
    if found < COLUMNS {
        return Err(format!(
            "the row has {found} columns, and the wind and clouds stand in the first {COLUMNS}: it is cut off or not an EPW row"
        ));
    }
    Ok(cells)
}

fn date(cells: &[&str; COLUMNS]) -> Result<Date, String> {
    let (month, day) = (whole(cells, 1, "month")?, whole(cells, 2, "day")?);
    Date::new(month, day).ok_or_else(|| not_a_number(cells, 2, "day of the month"))
}

fn whole(cells: &[&str; COLUMNS], column: usize, field: &str) -> Result<u32, String> {
    cells[column].parse().map_err(|_| not_a_number(cells, column, field))
}

/// A value, or NaN where it is missing.
fn value(cells: &[&str; COLUMNS], specification: &Specification) -> Result<f64, String> {
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
    let (name, column) = (field.name(), column + 1);
    Err(format!("column {column}, {name}, is {found}; possible are {least} to {greatest}, and missing is {missing}"))
}

fn not_a_number(cells: &[&str; COLUMNS], column: usize, field: &str) -> String {
    format!("column {}, {field}, is {}, not a number", column + 1, shown_cell(cells[column]))
}

/// A column of an EPW file that a run can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Field {
    /// Dry-bulb temperature at the end of the interval \[°C\].
    DryBulb,
    /// Global radiation on a horizontal plane during the interval \[Wh/m²\].
    GlobalHorizontal,
    /// Direct radiation on a plane towards the sun during the interval \[Wh/m²\].
    DirectNormal,
    /// Diffuse radiation on a horizontal plane during the interval \[Wh/m²\].
    DiffuseHorizontal,
}

/// What the data dictionary says about a field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Specification {
    pub(super) field: Field,
    /// Position in a row, from zero.
    pub(super) column: usize,
    /// A value from here on stands for a missing one.
    pub(super) missing: f64,
    pub(super) least: f64,
    pub(super) greatest: f64,
}

const fn specification(field: Field, column: usize, missing: f64, least: f64, greatest: f64) -> Specification {
    Specification { field, column, missing, least, greatest }
}

/// All fields, in the order of [`Field`].
pub(super) const FIELDS: [Specification; 4] = [
    specification(Field::DryBulb, 6, 99.9, -70.0, 70.0),
    specification(Field::GlobalHorizontal, 13, 9999.0, 0.0, 9999.0),
    specification(Field::DirectNormal, 14, 9999.0, 0.0, 9999.0),
    specification(Field::DiffuseHorizontal, 15, 9999.0, 0.0, 9999.0),
];

/// Columns that a row must have at least.
pub(super) const COLUMNS: usize = 23;

impl Field {
    /// The column's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::DryBulb => "dry-bulb temperature",
            Self::GlobalHorizontal => "global horizontal radiation",
            Self::DirectNormal => "direct normal radiation",
            Self::DiffuseHorizontal => "diffuse horizontal radiation",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specifications_of_epw_fields_are_in_the_order_of_the_fields() {
        assert!(FIELDS.iter().enumerate().all(|(i, specification)| specification.field as usize == i));
        assert!(FIELDS.iter().all(|specification| specification.column < COLUMNS));
    }
}
