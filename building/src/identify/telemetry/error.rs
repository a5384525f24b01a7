//! Errors of mappings and tables: their place, and what would work.

use std::fmt;

use interplay_common::bounds::Bound;
use interplay_common::setting::SettingKey;

/// Why a mapping or a table cannot be read.
///
/// Shown as `file:line:column: what is wrong; what would work`, with a line for each problem.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}{}: {problem}; {remedy}{}", Located(.place), Others(.others))]
pub struct TelemetryError {
    /// The name of the file, as the caller gave it.
    pub file: String,
    /// Line and column, from 1, the column in characters; `None` if no text is at fault (an empty file).
    pub place: Option<(usize, usize)>,
    /// What is wrong.
    pub problem: String,
    /// What would work.
    pub remedy: String,
    /// The other problems, in the order of the text.
    pub others: Vec<TelemetryError>,
}

/// A problem with the text of its remedy.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Problem {
    text: String,
    remedy: String,
}

impl Problem {
    pub fn new(text: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { text: text.into(), remedy: remedy.into() }
    }

    /// The value of a key is outside a bound.
    pub(crate) fn out_of_bounds(key: &SettingKey, value: f64, bound: Bound) -> Self {
        Self::new(format!("`{key}` is {value}"), format!("it must be {bound}"))
    }
}

impl TelemetryError {
    pub(super) fn new(file: &str, place: Option<(usize, usize)>, problem: Problem) -> Self {
        let Problem { text: problem, remedy } = problem;
        Self { file: file.into(), place, problem, remedy, others: Vec::new() }
    }

    /// One error with all others below the first; `None` if there are none.
    pub(super) fn of_all(mut all: Vec<Self>) -> Option<Self> {
        let others = all.split_off(all.len().min(1));
        all.pop().map(|first| Self { others, ..first })
    }
}

/// Names for a message; a long list is cut.
pub(super) fn listed(names: &[String]) -> String {
    const MAX_LISTED_NAMES: usize = 12;
    let shown: Vec<_> = names.iter().take(MAX_LISTED_NAMES).map(|name| format!("`{name}`")).collect();
    match names.len().checked_sub(MAX_LISTED_NAMES) {
        Some(more) if more > 0 => format!("{} and {more} more", shown.join(", ")),
        _ if shown.is_empty() => "none".into(),
        _ => shown.join(", "),
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
