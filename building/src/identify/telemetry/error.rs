//! What can be wrong with a mapping or a table: where it stands, and what would work.

use std::fmt;

use interplay_common::bounds::Bound;
use interplay_common::setting::{SettingError, SettingKey};
use interplay_common::spelling::suggestion;

use super::time_text::format_with_offset;
use super::value_shape::ValueShape;

/// A mapping or a table that cannot be read.
///
/// Shown as `file:line:column: what is wrong; what would work`, a line for each problem. Line and column count from 1, the column in
/// characters; both are `None` when no text is to blame (an empty file).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}{}: {problem}; {}{}", Located(.place), .problem.remedy(), Others(.others))]
pub struct TelemetryError {
    /// The name of the file, as the caller gave it.
    pub file: String,
    /// Line and column, from 1.
    pub place: Option<(usize, usize)>,
    /// What is wrong.
    pub problem: Box<TelemetryProblem>,
    /// What else is wrong, in the order of the text.
    pub others: Vec<TelemetryError>,
}

impl TelemetryError {
    pub(super) fn new(file: &str, place: Option<(usize, usize)>, problem: TelemetryProblem) -> Self {
        Self { file: file.into(), place, problem: Box::new(problem), others: Vec::new() }
    }

    /// One error of several; `None` where there are none.
    pub(super) fn of_all(mut all: Vec<Self>) -> Option<Self> {
        let others = all.split_off(all.len().min(1));
        all.pop().map(|first| Self { others, ..first })
    }
}

/// What is wrong with a mapping or a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TelemetryProblem {
    /// The mapping is not TOML.
    #[error("not valid TOML: {reason}")]
    Syntax {
        /// The message of the TOML reader.
        reason: String,
    },
    /// A table of the mapping has a key that is not known.
    #[error("unknown key `{key}`{}", within(.table))]
    UnknownKey {
        /// The table; entries of lists are called by their `name`, else by their number, as `zone.living.heat.0`.
        table: SettingKey,
        /// The unknown key.
        key: String,
        /// The keys that the table may have.
        known: Vec<String>,
    },
    /// A key of the mapping that has no default is not stated.
    #[error("`{key}` is missing")]
    MissingKey {
        /// The key, its table as in [`TelemetryProblem::UnknownKey`].
        key: SettingKey,
        /// The form that its value must have.
        wanted: ValueShape,
    },
    /// The value of a key is of the wrong type.
    #[error("`{key}` must be {wanted}, not {found}")]
    WrongType {
        /// The key, its table as in [`TelemetryProblem::UnknownKey`].
        key: SettingKey,
        /// The form that its value must have.
        wanted: ValueShape,
        /// The form that the value has.
        found: String,
    },
    /// The value of a key is none of the words that it may be.
    #[error("`{key}` cannot be `{word}`")]
    UnknownWord {
        /// The key, its table as in [`TelemetryProblem::UnknownKey`].
        key: SettingKey,
        /// The stated value.
        word: String,
        /// The words that are admissible.
        known: Vec<String>,
    },
    /// A number of the mapping breaks its bounds.
    #[error("`{key}` is {value}")]
    Setting {
        /// The key, its table as in [`TelemetryProblem::UnknownKey`].
        key: SettingKey,
        /// The stated value.
        value: f64,
        /// The bound that it breaks.
        bound: Bound,
    },
    /// The value of a key does not go together with that of another.
    #[error("`{key}` is {value}")]
    Conflict {
        /// The key, its table as in [`TelemetryProblem::UnknownKey`].
        key: SettingKey,
        /// The stated value.
        value: String,
        /// What to state instead.
        wanted: &'static str,
    },
    /// The mapping names a zone or boundary that it does not declare, or declares one twice.
    #[error("the name `{name}` in {field} is {fault}")]
    Name {
        /// The field, as `walls`.
        field: &'static str,
        /// The name at fault.
        name: String,
        /// `unknown`, or `used twice`.
        fault: &'static str,
        /// The names that are known.
        known: Vec<String>,
    },
    /// The table has no rows.
    #[error("the table is empty")]
    Empty,
    /// The mapping names a column that the table has not, or has twice.
    #[error("column `{name}`, wanted as {role}, is {fault}")]
    Column {
        /// Name of the column.
        name: String,
        /// The quantity that the column is to hold, as `temperature of zone living`.
        role: String,
        /// `not in the header`, or `in the header twice`.
        fault: &'static str,
        /// The titles of the header.
        header: Vec<String>,
    },
    /// A row is broken: wrong number of fields, or bytes that are no text.
    #[error("the row cannot be read: {reason}")]
    Row {
        /// Why the row cannot be read.
        reason: String,
    },
    /// A field is not a number.
    #[error("`{text}` in column `{column}` is not a number")]
    Number {
        /// The field's text.
        text: String,
        /// Name of the column.
        column: String,
    },
    /// A field is not a time of the expected form.
    #[error("`{text}` in column `{column}` is not a time of the form `{format}`")]
    Time {
        /// The field's text.
        text: String,
        /// Name of the column.
        column: String,
        /// The form that the mapping states.
        format: String,
    },
    /// Clocks of the stated time zone never showed this.
    #[error("clocks of {zone} never showed {text}: they were put forward")]
    NoSuchHour {
        /// The time, as read.
        text: String,
        /// The time zone.
        zone: String,
    },
    /// The count of a meter falls.
    #[error("the meter in column `{column}` falls from {from} to {to}")]
    CounterFalls {
        /// Name of the column.
        column: String,
        /// The count before.
        from: f64,
        /// The count in this row.
        to: f64,
    },
    /// The time between two rows is not the sampling time.
    #[error("`{text}` is {elapsed_s} s after the row before, and the sampling time is {step_s} s: {}", kind_of_gap(*.elapsed_s))]
    Gap {
        /// The later row's time, as written.
        text: String,
        /// Time since the row before \[s\].
        elapsed_s: f64,
        /// The sampling time \[s\].
        step_s: f64,
        /// Whether clocks that are put forward or back would explain it: it is wrong by an hour, and nothing is said of the clocks.
        is_hour_of_clocks: bool,
    },
    /// A value is missing where the mapping wants every row complete.
    #[error("column `{column}` has no value here (`{text}`)")]
    Missing {
        /// The field's text.
        text: String,
        /// Name of the column.
        column: String,
    },
    /// A physical quantity is out of the range of any building.
    #[error("{value} {unit} in column `{column}` is outside {low} to {high} {unit}")]
    Range {
        /// The value after conversion.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
        /// Name of the column.
        column: String,
        /// The lowest value accepted.
        low: f64,
        /// The highest value accepted.
        high: f64,
    },
}

impl TelemetryProblem {
    /// A setting out of range, in the table of that key.
    pub(super) fn setting(table: &SettingKey, error: &SettingError) -> Self {
        Self::Setting { key: table.key(error.key.as_str()), value: error.value, bound: error.bound }
    }

    /// What to state or do instead, as the help of an error message.
    pub fn remedy(&self) -> String {
        match self {
            Self::Syntax { .. } | Self::WrongType { .. } => {
                "`interplay identify --help` shows a mapping, docs/guide/identification.md every key".into()
            }
            Self::UnknownKey { key, known, .. } => suggestion(key, "the keys here are", known),
            Self::MissingKey { wanted, .. } => format!("it must be {wanted}"),
            Self::UnknownWord { word, known, .. } => suggestion(word, "choose from", known),
            Self::Setting { bound, .. } => format!("it must be {bound}"),
            Self::Conflict { wanted, .. } => format!("it must be {wanted}"),
            Self::Name { known, .. } => format!("known names: {}", listed(known)),
            Self::Empty => "it needs a header and at least two rows".into(),
            Self::Column { header, .. } => {
                format!("the header has {}; check `table.separator` if this is one column", listed(header))
            }
            Self::Row { .. } => "every row needs as many fields as the header".into(),
            Self::Number { .. } => {
                "write a number like 21.5 (`table.decimal` sets the decimal sign), or list the text in `table.missing`".into()
            }
            Self::Time { text, format, .. } => match format_with_offset(format, text) {
                Some(format) => format!("it has an offset from UTC: set `time.format` to `{format}`, in place of a `time.zone`"),
                None => "set `time.format` to the form of the column, for example `%Y-%m-%d %H:%M:%S`".into(),
            },
            Self::NoSuchHour { .. } => {
                "leave `time.zone` out if these clocks are not put forward and back, or correct it".into()
            }
            Self::CounterFalls { .. } => {
                "begin another recording where a meter was changed (`time.batch`), or state `reading` if rows are no counts".into()
            }
            Self::Gap { is_hour_of_clocks: true, .. } => {
                "state `time.zone` if clocks are put forward or back here, or write times with an offset (`%z` in `time.format`); or add \
                 the missing rows, or set `time.gaps = \"split\"` to start anew after each gap"
                    .into()
            }
            Self::Gap { .. } => {
                "add the missing rows, correct `time.step_s`, or set `time.gaps = \"split\"` to start anew after each gap".into()
            }
            Self::Missing { .. } => {
                "fill the value in, or set `time.gaps = \"split\"` to leave such rows out and start anew".into()
            }
            Self::Range { .. } => {
                "check the unit in the mapping, or list the text in `table.missing` if it stands for no value".into()
            }
        }
    }
}

/// Where an unknown key stands; nothing for the outermost table.
fn within(table: &SettingKey) -> String {
    if *table == SettingKey::default() { String::new() } else { format!(" in `{table}`") }
}

/// Names for a message; a long list is cut.
fn listed(names: &[String]) -> String {
    const MAX_LISTED_NAMES: usize = 12;
    let shown: Vec<_> = names.iter().take(MAX_LISTED_NAMES).map(|name| format!("`{name}`")).collect();
    match names.len().checked_sub(MAX_LISTED_NAMES) {
        Some(more) if more > 0 => format!("{} and {more} more", shown.join(", ")),
        _ if shown.is_empty() => "none".into(),
        _ => shown.join(", "),
    }
}

fn kind_of_gap(elapsed_s: f64) -> &'static str {
    match elapsed_s {
        elapsed if elapsed < 0.0 => "time goes backwards",
        0.0 => "one time stands twice",
        _ => "there is a gap, or the sampling time is another",
    }
}

/// Writes the other errors below the first.
struct Others<'a>(&'a [TelemetryError]);

impl fmt::Display for Others<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|error| write!(f, "\n{error}"))
    }
}

/// Writes a place as `:line:column`.
struct Located<'a>(&'a Option<(usize, usize)>);

impl fmt::Display for Located<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some((line, column)) => write!(f, ":{line}:{column}"),
            None => Ok(()),
        }
    }
}
