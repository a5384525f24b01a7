//! How a command ends.

use std::process::ExitCode;

/// How a command ended, from well to worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ExitStatus {
    /// Everything that was asked for was done and held.
    Well,
    /// An expectation failed.
    Failed,
    /// The input was wrong.
    BadInput,
    /// A run could not be finished.
    Unfinished,
}

impl From<ExitStatus> for ExitCode {
    fn from(ending: ExitStatus) -> Self {
        match ending {
            ExitStatus::Well => ExitCode::SUCCESS,
            ExitStatus::Failed => ExitCode::from(1),
            ExitStatus::BadInput => ExitCode::from(2),
            ExitStatus::Unfinished => ExitCode::from(3),
        }
    }
}
