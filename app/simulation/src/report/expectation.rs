//! One expectation of a scenario and what became of it.

use std::fmt;

use serde::Serialize;
use serde_json::Value;

/// One expectation and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expectation {
    /// The key in the scenario file, with the vehicle where there is one.
    pub what: String,
    /// What was expected.
    pub want: Value,
    /// What happened.
    pub got: Value,
    /// Whether it held.
    pub passed: bool,
}

impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: want {}, got {}", self.what, self.want, self.got)
    }
}
