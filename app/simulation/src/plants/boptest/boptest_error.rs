//! Errors of a BOPTEST test case.

use std::io;

use interplay_fmu_host::HostError;
use thiserror::Error;

/// Why BOPTEST gave no usable answer. `request` is a method and a path.
#[derive(Debug, Error)]
pub enum BoptestError {
    /// The case is an FMU, and its process or its files failed.
    #[error(transparent)]
    Unit(#[from] HostError),
    /// The case is an FMU that lacks requested data, or gives values that cannot be used.
    #[error("the FMU does not serve as the building: {reason}")]
    Case {
        /// What is missing or wrong.
        reason: String,
    },
    /// No server listens, or the host is unknown.
    #[error(
        "cannot connect to BOPTEST at {url}: {reason}; start its server before the run, or change `building.plant.url`"
    )]
    Connect {
        /// Address of the server.
        url: String,
        /// The system's reason.
        reason: io::Error,
    },
    /// The server did not answer in time.
    #[error("BOPTEST gave no answer to `{request}` within {timeout_s} s; `building.plant.timeout_s` is that limit")]
    Timeout {
        /// The request.
        request: String,
        /// Longest time of an answer \[s\].
        timeout_s: f64,
    },
    /// The connection broke.
    #[error("the connection to BOPTEST broke at `{request}`: {reason}")]
    Broken {
        /// The request.
        request: String,
        /// The system's reason.
        reason: io::Error,
    },
    /// The answer is too long.
    #[error("BOPTEST's answer to `{request}` is longer than {limit} bytes")]
    TooLong {
        /// The request.
        request: String,
        /// The longest answer \[bytes\].
        limit: usize,
    },
    /// The answer does not follow the interface.
    #[error("BOPTEST's answer to `{request}` is not valid: {reason}")]
    Invalid {
        /// The request.
        request: String,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// The server refused the request.
    #[error("BOPTEST refused `{request}` with status {status}: {message}")]
    Refused {
        /// The request.
        request: String,
        /// The status of HTTP, or the one in the answer.
        status: u16,
        /// The server's message.
        message: String,
    },
    /// A name in the scenario does not exist in the case.
    #[error("the case has no {what} `{name}`, which `{key}` names; it has {known}")]
    UnknownName {
        /// What kind of name.
        what: &'static str,
        /// The name.
        name: String,
        /// The key of the scenario.
        key: String,
        /// Some of the existing names.
        known: String,
    },
}

impl BoptestError {
    /// The error of a case that is an FMU: it speaks of the unit, not of a server and its requests.
    pub(crate) fn of_unit(self) -> Self {
        match self {
            Self::Invalid { reason, .. } => Self::Case { reason },
            other => other,
        }
    }
}
