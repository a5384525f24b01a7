//! Why a command gave up after it had begun.

use std::io;
use std::path::{Path, PathBuf};

use interplay_presentation::animation::AnimationError;
use interplay_presentation::figures::FigureError;
use interplay_presentation::plot::PlotError;
use interplay_presentation::record::RecordError;
use interplay_simulation::run::RunError;
use thiserror::Error;

use crate::run_outputs::OutputError;

/// Why a command has no result, or why the result is not where it should be.
#[derive(Debug, Error)]
pub(crate) enum CommandError {
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Record(#[from] RecordError),
    #[error(transparent)]
    Figure(#[from] FigureError),
    #[error(transparent)]
    Plot(#[from] PlotError),
    #[error(transparent)]
    Animation(#[from] AnimationError),
    #[error(transparent)]
    RunOutput(#[from] OutputError),
    #[error("{scenario}: {reason}")]
    FailedAnimation { scenario: String, reason: AnimationError },
    #[error("cannot write `{}`: {reason}; choose another place for it", path.display())]
    Unwritable { path: PathBuf, reason: io::Error },
    #[error("{what} cannot be written as JSON: {reason}")]
    Json { what: &'static str, reason: serde_json::Error },
    #[error("the results cannot be written as XML: {0}")]
    Xml(Box<dyn std::error::Error + Send + Sync>),
    #[error("cannot write to the standard output: {0}")]
    Output(io::Error),
    #[error("cannot start {jobs} threads: {reason}")]
    Threads { jobs: usize, reason: rayon::ThreadPoolBuildError },
}

/// Writes a file atomically.
pub(crate) fn write_file(path: &Path, content: &[u8]) -> Result<(), CommandError> {
    interplay_files::write(path, content).map_err(|reason| CommandError::Unwritable { path: path.to_owned(), reason })
}

/// How a command ended, from well to worst; its number is the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ExitStatus {
    /// The command did its work, and all expectations held.
    Well = 0,
    /// An expectation failed.
    Failed = 1,
    /// The input was wrong.
    BadInput = 2,
    /// A run could not be finished.
    Unfinished = 3,
}
