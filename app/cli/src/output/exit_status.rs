//! Exit codes of commands.

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
