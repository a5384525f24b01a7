//! How a command ends.

use std::process::ExitCode;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// All well.
    Well,
    /// An expectation failed.
    Failed,
    /// Bad input.
    BadInput,
    /// A run could not be finished.
    Unfinished,
}

impl From<Ending> for ExitCode {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::Well => ExitCode::SUCCESS,
            Ending::Failed => ExitCode::from(1),
            Ending::BadInput => ExitCode::from(2),
            Ending::Unfinished => ExitCode::from(3),
        }
    }
}
