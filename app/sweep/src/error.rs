//! Errors of sweeps.

use std::io;
use std::path::{Path, PathBuf};

use interplay_scenarios::LoadError;
use interplay_tables::TableError;
use thiserror::Error;

/// Why a sweep, a merge or a comparison failed.
#[derive(Debug, Error)]
pub enum SweepError {
    /// Runs of the plan are refused; nothing was run.
    #[error("{0}")]
    Refused(Box<LoadError>),
    /// A file or a table cannot be read or written.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A line of a journal is damaged.
    #[error("{}:{line}: this is not a row: {reason}; without this line the run is made again", path.display())]
    Journal {
        /// The journal.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The reason.
        reason: serde_json::Error,
    },
    /// A line of a journal does not match its checksum.
    #[error("{}:{line}: the row is damaged: its checksum is another", path.display())]
    Damaged {
        /// The journal.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
    /// The system has no threads for it.
    #[error("{0}")]
    Threads(String),
    /// Another process works on the shard.
    #[error("`{}` is in use: another process works on this shard", .0.display())]
    InUse(PathBuf),
    /// The user's inputs are inconsistent.
    #[error("{0}")]
    Input(String),
    /// A file exists where the folder of the rows, or a folder above it, must be.
    #[error("`{}` is a file, and the rows of a sweep need a folder; choose another with `--out`", .0.display())]
    FileInTheWay(PathBuf),
    /// A recording could not be written.
    #[error("{0}")]
    Recording(String),
    /// The caller has ended the sweep.
    #[error("the sweep was cancelled; its rows are kept, and the same call makes the rest")]
    Cancelled,
}

impl SweepError {
    /// Whether the input causes the error, and not the machine.
    pub fn is_bad_input(&self) -> bool {
        matches!(
            self,
            SweepError::Refused(_)
                | SweepError::Journal { .. }
                | SweepError::Damaged { .. }
                | SweepError::Input(_)
                | SweepError::Table(TableError::Input(_) | TableError::Table { what: "read", .. })
        )
    }

    pub(crate) fn file<'a>(what: &'static str, path: &'a Path) -> impl Fn(io::Error) -> SweepError + 'a {
        move |reason| TableError::file(what, path)(reason).into()
    }
}
