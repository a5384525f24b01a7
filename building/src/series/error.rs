//! What is wrong with a table of series, and where.

/// A table of series that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct SeriesError {
    /// The line, from one.
    pub line: usize,
    /// What is wrong, and what would work.
    pub problem: String,
}

impl SeriesError {
    pub(super) fn new(line: usize, problem: impl Into<String>) -> Self {
        Self { line, problem: problem.into() }
    }
}
