//! What can go wrong with a plant behind a socket.

use std::io;
use std::ops::RangeInclusive;

use thiserror::Error;

/// Temperatures of zones that a plant may answer \[°C\].
pub const TEMPERATURES_C: RangeInclusive<f64> = -100.0..=200.0;

/// Why a plant behind a socket gave no temperatures.
#[derive(Debug, Error)]
pub enum PlantError {
    /// Nobody listens, or the address is unknown.
    #[error(
        "cannot connect to the plant at {address}: {reason}; start the program that answers there before the run, or \
         change `building.plant.address`"
    )]
    Connect {
        /// Where it should listen.
        address: String,
        /// What the system says.
        reason: io::Error,
    },
    /// No answer in time.
    #[error("the plant gave no answer to {question} within {timeout_s} s; `building.plant.timeout_s` is that limit")]
    Timeout {
        /// What it was asked.
        question: String,
        /// How long it may take \[s\].
        timeout_s: f64,
    },
    /// The connection has ended.
    #[error("the plant closed the connection instead of answering {question}")]
    Closed {
        /// What it was asked.
        question: String,
    },
    /// The connection is broken.
    #[error("the connection to the plant broke at {question}: {reason}")]
    Broken {
        /// What it was asked.
        question: String,
        /// What the system says.
        reason: io::Error,
    },
    /// A line that never ends.
    #[error("the plant's answer to {question} is longer than {limit} bytes; an answer is one line of JSON")]
    TooLong {
        /// What it was asked.
        question: String,
        /// The longest answer \[bytes\].
        limit: usize,
    },
    /// Something else than a message of the protocol.
    #[error("the plant's answer to {question} is no message of the protocol: {reason}, in `{answer}`")]
    NoMessage {
        /// What it was asked.
        question: String,
        /// What the reader says.
        reason: String,
        /// The beginning of the answer.
        answer: String,
    },
    /// A message that has no place here.
    #[error("the plant's answer to {question} is not valid: {reason}")]
    Invalid {
        /// What it was asked.
        question: String,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// A number that cannot be sent.
    #[error("heat or gains of zone `{zone}` at {question} are no finite number, which cannot be sent to the plant")]
    NotFinite {
        /// What was to be asked.
        question: String,
        /// The first zone with such a number.
        zone: String,
    },
    /// The other program says that it cannot go on.
    #[error("the plant reports an error at {question}: {reason}")]
    Reported {
        /// What it was asked.
        question: String,
        /// What it says.
        reason: String,
    },
}
