//! Values of a table, and the types of its columns.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    Flag,
    Count,
    Number,
    Text,
}

/// The name and the type of each column of a table.
pub type TableSchema = Vec<(String, ColumnKind)>;

/// A value of a row; `None` is a missing value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    Flag(Option<bool>),
    Count(Option<u64>),
    Number(Option<f64>),
    Text(Option<String>),
}

/// Why a table cannot be read or written.
#[derive(Debug, Error)]
pub enum TableError {
    /// A file cannot be read or written.
    #[error("cannot {what} `{}`: {reason}", path.display())]
    File { what: &'static str, path: PathBuf, reason: io::Error },
    /// A table cannot be read or written.
    #[error("cannot {what} the rows of `{}`: {reason}", path.display())]
    Table { what: &'static str, path: PathBuf, reason: Box<dyn Error + Send + Sync> },
    /// The user's inputs are inconsistent.
    #[error("{0}")]
    Input(String),
}

impl TableError {
    /// Makes the error of an operation on a file from the system's reason.
    pub fn file<'a>(what: &'static str, path: &'a Path) -> impl Fn(io::Error) -> TableError + 'a {
        move |reason| TableError::File { what, path: path.to_owned(), reason }
    }

    pub(crate) fn table<'a, E: Error + Send + Sync + 'static>(
        what: &'static str,
        path: &'a Path,
    ) -> impl Fn(E) -> TableError + 'a {
        move |reason| TableError::Table { what, path: path.to_owned(), reason: Box::new(reason) }
    }
}
