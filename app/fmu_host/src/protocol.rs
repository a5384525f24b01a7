//! The lines of JSON between the parent and the process that calls the unit.

use serde::{Deserialize, Serialize};

/// What the parent asks. References are those of the description.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "call", rename_all = "kebab-case")]
pub enum Request {
    /// `fmi2SetupExperiment`, `fmi2EnterInitializationMode`, `fmi2ExitInitializationMode`.
    Initialize {
        /// When the simulation begins \[s\].
        start_s: f64,
    },
    /// `fmi2SetReal` and `fmi2SetBoolean`, before the next step.
    Set {
        /// Numbers by their references.
        reals: Vec<(u32, f64)>,
        /// Booleans by their references.
        booleans: Vec<(u32, bool)>,
    },
    /// `fmi2GetReal`, `fmi2GetBoolean` and `fmi2GetString`, now.
    Get {
        /// References of numbers.
        reals: Vec<u32>,
        /// References of booleans.
        booleans: Vec<u32>,
        /// References of texts.
        strings: Vec<u32>,
    },
    /// `fmi2DoStep` again and again, and after each step the numbers.
    Steps {
        /// When the first step begins \[s\].
        from_s: f64,
        /// Length of a step \[s\].
        step_s: f64,
        /// How many steps.
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
    /// The request in a word, for errors.
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

/// What the process answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "answer", rename_all = "kebab-case")]
pub enum HostAnswer {
    /// It is done. Also the first line of all, when the unit has been instantiated.
    Done,
    /// What was read.
    Values(Values),
    /// It failed.
    Failed {
        /// Why, in words.
        reason: String,
    },
}

/// What was read of a unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Values {
    /// A row for each step, or one for now: the numbers, and then the booleans as 0 or 1. A number that is not finite is missing.
    pub rows: Vec<Vec<Option<f64>>>,
    /// Texts.
    pub strings: Vec<String>,
}
