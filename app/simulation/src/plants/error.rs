//! Errors of a plant behind a socket.

use std::io;
use std::ops::RangeInclusive;

use thiserror::Error;

use crate::plants::boptest::BoptestError;

/// Plausible temperatures of zones in a plant's answer \[°C\].
pub const TEMPERATURES_C: RangeInclusive<f64> = -100.0..=200.0;

/// Why a plant in another program gave no temperatures.
#[derive(Debug, Error)]
pub enum PlantError {
    /// A server of BOPTEST did not answer as agreed.
    #[error(transparent)]
    Boptest(#[from] BoptestError),
    /// No program listens, or the address is unknown.
    #[error(
        "cannot connect to the plant at {address}: {reason}; start the program that answers there before the run, or \
         change `building.plant.address`"
    )]
    Connect {
        /// Address of the program.
        address: String,
        /// The system's reason.
        reason: io::Error,
    },
    /// The program did not answer in time.
    #[error("the plant gave no answer to {question} within {timeout_s} s; `building.plant.timeout_s` is that limit")]
    Timeout {
        /// The question that was asked, in words.
        question: String,
        /// Longest time of an answer \[s\].
        timeout_s: f64,
    },
    /// The connection has ended.
    #[error("the plant closed the connection instead of answering {question}")]
    Closed {
        /// The question that was asked, in words.
        question: String,
    },
    /// The connection is broken.
    #[error("the connection to the plant broke at {question}: {reason}")]
    Broken {
        /// The question that was asked, in words.
        question: String,
        /// The system's reason.
        reason: io::Error,
    },
    /// The answer is a line that is too long.
    #[error("the plant's answer to {question} is longer than {limit} bytes; an answer is one line of JSON")]
    TooLong {
        /// The question that was asked, in words.
        question: String,
        /// The longest answer \[bytes\].
        limit: usize,
    },
    /// The answer is not a message of the protocol.
    #[error("the plant's answer to {question} is not a message of the protocol: {reason}, in `{answer}`")]
    NoMessage {
        /// The question that was asked, in words.
        question: String,
        /// The message of the JSON reader.
        reason: String,
        /// The beginning of the answer.
        answer: String,
    },
    /// The answer is a message that does not answer the question.
    #[error("the plant's answer to {question} is not valid: {reason}")]
    Invalid {
        /// The question that was asked, in words.
        question: String,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// A number of the question is not finite and cannot be sent.
    #[error("heat or gains of zone `{zone}` at {question} are not finite and cannot be sent to the plant")]
    NotFinite {
        /// The question, in words.
        question: String,
        /// The first zone with such a number.
        zone: String,
    },
    /// The other program reports that it cannot continue.
    #[error("the plant reports an error at {question}: {reason}")]
    Reported {
        /// The question that was asked, in words.
        question: String,
        /// The program's reason.
        reason: String,
    },
}
