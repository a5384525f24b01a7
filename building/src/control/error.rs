//! Why a controller cannot do its work.

use interplay_convex::{ProblemError, SolveError};

/// Why a controller cannot be started, or cannot plan a day.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ControlError {
    /// A setting is out of range.
    #[error("{setting} is {value}; it must be {wanted}")]
    Setting {
        /// The setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What would work.
        wanted: &'static str,
    },
    /// A series has another length than the day.
    #[error("{what} has {found} numbers; a day of this building needs {wanted}")]
    Shape {
        /// The series.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The right length.
        wanted: usize,
    },
    /// The clairvoyant was not told what will happen.
    #[error("the clairvoyant controller needs to be told the day's actual weather and occupancy")]
    NotClairvoyant,
    /// The day's optimum needs the model as matrices, which an exact model of this size has not.
    #[error(
        "the day's optimum is not available for the exact model of {nodes} temperatures, at most {most}: use \
         forward Euler"
    )]
    TooLarge {
        /// How many temperatures the network has.
        nodes: usize,
        /// Up to how many there are matrices.
        most: usize,
    },
    /// The optimisation problem is malformed.
    #[error("the day's optimum cannot be posed: {0}")]
    Problem(#[from] ProblemError),
    /// The optimisation problem was not solved.
    #[error("the day's optimum was not found: {0}")]
    Solve(#[from] SolveError),
}

impl ControlError {
    /// Refuses a series of the wrong length.
    pub(super) fn check_length(what: &'static str, found: usize, wanted: usize) -> Result<(), Self> {
        if found == wanted { Ok(()) } else { Err(Self::Shape { what, found, wanted }) }
    }

    /// Refuses a setting that is negative or no number.
    pub(super) fn check_not_negative(settings: &[(&'static str, f64)]) -> Result<(), Self> {
        match settings.iter().find(|(_, value)| !(*value >= 0.0 && value.is_finite())) {
            Some(&(setting, value)) => Err(Self::Setting { setting, value, wanted: "a number, at least 0" }),
            None => Ok(()),
        }
    }
}
