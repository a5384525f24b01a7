//! The lines of JSON between the parent and the process that calls the unit.

use serde::{Deserialize, Serialize};

/// A request of the parent process. It names variables by the references of the unit's description.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "call", rename_all = "kebab-case")]
pub enum Request {
    /// `fmi2SetupExperiment`, `fmi2EnterInitializationMode`, `fmi2ExitInitializationMode`.
    Initialize {
        /// Start time of the simulation \[s\].
        start_s: f64,
    },
    /// `fmi2SetReal` and `fmi2SetBoolean`, before the next step.
    Set {
        /// Numbers by their references.
        reals: Vec<(u32, f64)>,
        /// Booleans by their references.
        booleans: Vec<(u32, bool)>,
    },
    /// `fmi2GetReal`, `fmi2GetBoolean` and `fmi2GetString`: current values.
    Get {
        /// References of numbers.
        reals: Vec<u32>,
        /// References of booleans.
        booleans: Vec<u32>,
        /// References of texts.
        strings: Vec<u32>,
    },
    /// Repeated `fmi2DoStep`, with the values after each step.
    Steps {
        /// Start time of the first step \[s\].
        from_s: f64,
        /// Length of a step \[s\].
        step_s: f64,
        /// Number of steps.
        count: usize,
        /// References of the numbers.
        reals: Vec<u32>,
        /// References of booleans, which become 0 or 1 and follow the numbers.
        booleans: Vec<u32>,
    },
    /// `fmi2Reset`.
    Reset,
    /// `fmi2Terminate` and `fmi2FreeInstance`; the process then ends.
    End,
}

impl Request {
    /// The name of the request, for errors.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Initialize { .. } => "initialize",
            Self::Set { .. } => "set",
            Self::Get { .. } => "get",
            Self::Steps { .. } => "step",
            Self::Reset => "reset",
            Self::End => "end",
        }
    }
}

/// The answer of the process.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "answer", rename_all = "kebab-case")]
pub enum HostAnswer {
    /// The request is done. Also the first line, which says that the unit has been instantiated.
    Done,
    /// The values that were read.
    Values(Values),
    /// The request failed.
    Failed {
        /// The reason, in words.
        reason: String,
    },
}

/// Values that were read from a unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Values {
    /// One row for each step, or a single row of current values: the numbers, then the booleans as 0 or 1. `None` if not finite.
    pub rows: Vec<Vec<Option<f64>>>,
    /// Texts.
    pub strings: Vec<String>,
}
