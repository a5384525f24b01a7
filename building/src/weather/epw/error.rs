//! What can be wrong with an EPW file, and where.

use interplay_common::cell::shown_cell;

use super::calendar::Stamp;

/// Why a file is no complete EPW file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct EpwError {
    /// The line, from one.
    pub line: usize,
    /// What is wrong with it.
    pub problem: EpwProblem,
}

/// What is wrong with a line of an EPW file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EpwProblem {
    /// The file does not begin like an EPW file.
    #[error("an EPW file begins with `LOCATION,`, and this does not")]
    NotEpw,
    /// The header ends early.
    #[error("the file ends before its `{wanted}` line")]
    HeaderCut {
        /// The header line that is missing.
        wanted: &'static str,
    },
    /// A field of the header cannot be read.
    #[error("{field} is {}; it should be {wanted}", shown_cell(found))]
    Header {
        /// The field.
        field: &'static str,
        /// The text that was found.
        found: String,
        /// The form that it must have.
        wanted: &'static str,
    },
    /// A row has too few columns.
    #[error(
        "the row has {found} columns, and the wind and clouds stand in the first {wanted}: it is cut off or no EPW row"
    )]
    ShortRow {
        /// Number of columns that the row has.
        found: usize,
        /// Number of columns that are needed.
        wanted: usize,
    },
    /// A column holds no number.
    #[error("column {column}, {field}, is {}, not a number", shown_cell(found))]
    NotANumber {
        /// Position of the column, from one.
        column: usize,
        /// Name of the column.
        field: &'static str,
        /// The text that was found.
        found: String,
    },
    /// A column holds an impossible value.
    #[error("column {column}, {field}, is {found}; possible are {least} to {greatest}, and missing is {missing}")]
    Impossible {
        /// Position of the column, from one.
        column: usize,
        /// Name of the column.
        field: &'static str,
        /// The value that was found.
        found: f64,
        /// Least possible value.
        least: f64,
        /// Greatest possible value.
        greatest: f64,
        /// The value that marks a missing one.
        missing: f64,
    },
    /// A row is not the one that follows.
    #[error("this is {found}, but {wanted} comes next: rows are missing, repeated or out of order")]
    OutOfOrder {
        /// The time that the row states.
        found: Stamp,
        /// The time that comes next.
        wanted: Stamp,
    },
    /// Rows are missing at the end.
    #[error("the file ends here, with {found} rows; its header promises data up to {wanted}")]
    CutOff {
        /// Number of rows that the file has.
        found: usize,
        /// The last row that should be there.
        wanted: Stamp,
    },
    /// Rows go on after the promised end.
    #[error("a row after {end}, where the data end according to the header")]
    TooLong {
        /// The last row that should be there.
        end: Stamp,
    },
    /// The file states no outdoor temperature at all.
    #[error("every dry-bulb temperature is marked as missing")]
    NoTemperature,
    /// A field that is used has no values at all.
    #[error("every {field} is marked as missing, and the run uses it")]
    NoValues {
        /// Name of the column.
        field: &'static str,
    },
    /// A field that is used is missing for longer than may be bridged.
    #[error("column {column}, {field}, is missing for {hours} h from here on, and at most {limit_h} h are bridged")]
    Gap {
        /// Position of the column, from one.
        column: usize,
        /// Name of the column.
        field: &'static str,
        /// How long the values are missing \[h\].
        hours: f64,
        /// The longest gap that is bridged \[h\].
        limit_h: f64,
    },
}
