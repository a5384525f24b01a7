//! Errors of EPW files, with their lines.

use std::fmt;

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
