//! Why a benchmark could not be run or an entry was refused.

use std::io;
use std::path::PathBuf;

use interplay_scenarios::{LoadError, RegistryError};
use interplay_simulation::run::RunError;
use thiserror::Error;

/// Why a benchmark could not be run or an entry was refused.
#[derive(Debug, Error)]
pub enum BenchError {
    /// The planner does not exist, or one of its settings is wrong.
    #[error(transparent)]
    Planner(#[from] Box<LoadError>),
    /// A kind of the benchmark is registered already.
    #[error(transparent)]
    Registry(#[from] RegistryError),
    /// A run could not be finished.
    #[error("{id}: {reason}")]
    Run {
        /// The start.
        id: String,
        /// The reason.
        reason: Box<RunError>,
    },
    /// The reference driver does not reach the goal alone, so the start has no reference time.
    #[error("{id}: the reference driver does not reach the goal alone")]
    NoReference {
        /// The start.
        id: String,
    },
    /// Nothing is selected.
    #[error("no start is selected: {0}")]
    Selection(String),
    /// The program of a planner cannot be started.
    #[error("cannot start `{command}`: {reason}")]
    Command {
        /// The command.
        command: String,
        /// The reason.
        reason: io::Error,
    },
    /// A file cannot be read or written.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: io::Error,
    },
    /// A file is not an entry.
    #[error("{} is not an entry: {reason}", path.display())]
    NotAnEntry {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// An entry does not hold what it claims.
    #[error("the entry is refused: {0}")]
    Refused(String),
}

impl BenchError {
    /// Whether the caller's input is at fault, and not a run.
    pub fn is_bad_input(&self) -> bool {
        !matches!(self, BenchError::Run { .. } | BenchError::NoReference { .. })
    }
}
