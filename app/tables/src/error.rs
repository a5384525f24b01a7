//! Errors of reading and writing tables.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a table cannot be read or written.
#[derive(Debug, Error)]
pub enum TableError {
    /// A file cannot be read or written.
    #[error("cannot {what} `{}`: {reason}", path.display())]
    File {
        /// The operation.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: io::Error,
    },
    /// A table cannot be read or written.
    #[error("cannot {what} the rows of `{}`: {reason}", path.display())]
    Table {
        /// The operation.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: Box<dyn Error + Send + Sync>,
    },
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
