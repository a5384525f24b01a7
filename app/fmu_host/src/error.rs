//! Errors of a functional mock-up unit and of the process that runs it.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Why a unit cannot be started or cannot continue.
#[derive(Debug, Error)]
pub enum HostError {
    /// The file cannot be read.
    #[error("cannot read the FMU {}: {reason}", path.display())]
    Read { path: PathBuf, reason: io::Error },
    /// The file is not an archive.
    #[error("{} is not an FMU: {reason}", path.display())]
    Archive { path: PathBuf, reason: String },
    /// The unit is described as one that this program cannot run.
    #[error("cannot run the FMU {}: {reason}", path.display())]
    Description { path: PathBuf, reason: String },
    /// The files of the unit cannot be unpacked to the disk.
    #[error("cannot unpack the FMU: {reason}")]
    Unpack { reason: io::Error },
    /// The program that calls the unit cannot be started.
    #[error(
        "cannot start `{program}`, which runs FMUs: {reason}; `interplay` must be found there or in the search path"
    )]
    Start { program: String, reason: io::Error },
    /// The process has ended.
    #[error("the FMU crashed at `{question}`: its process ended with {how}{said}")]
    Crashed {
        question: String,
        /// The exit code or the signal.
        how: String,
        /// The last line that it wrote to the standard error, or nothing.
        said: String,
    },
    /// The process did not answer in time.
    #[error(
        "the FMU gave no answer to `{question}` within {timeout_s} s{said}; `building.plant.timeout_s` is that limit"
    )]
    Timeout {
        question: String,
        /// Longest time of an answer \[s\].
        timeout_s: f64,
        /// The last line that it wrote to the standard error, or nothing.
        said: String,
    },
    /// The unit or its library refused.
    #[error("the FMU failed at `{question}`: {reason}")]
    Failed { question: String, reason: String },
}
