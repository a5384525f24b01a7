//! Errors of controllers.

use std::cmp::Ordering;

use interplay_common::setting::{SettingError, SettingKey};
use interplay_convex::{ProblemError, SolveError};

use crate::discretise::ModelError;
use crate::staged::StagedError;

/// Largest magnitude of a temperature \[°C\] or of a heat flow \[kW\]. Chosen far beyond any building; larger numbers are
/// errors of the input.
const MAX_TEMPERATURE_C_OR_HEAT_KW: f64 = 1e6;

/// Why a controller cannot be started, or cannot plan a day.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ControlError {
    /// A setting is out of range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A series has another length than the day.
    #[error("{what} has {found} numbers; a day of this building needs {wanted}")]
    Shape {
        /// Name of the series.
        what: &'static str,
        /// Length of the series.
        found: usize,
        /// Length that it must have.
        wanted: usize,
    },
    /// A series holds a NaN, or an implausibly large number.
    #[error("{what} is {value} at place {index}; a day can only be planned with numbers of less than a million")]
    NotFinite {
        /// Name of the series.
        what: &'static str,
        /// Index of the number, from zero.
        index: usize,
        /// The number that is refused.
        value: f64,
    },
    /// A covariance is not positive definite.
    #[error(
        "the covariance of the disturbance, {order} by {order}, is not positive definite: its correlations contradict"
    )]
    Covariance {
        /// Number of rows of the matrix.
        order: usize,
    },
    /// No feedback satisfies a robust bound.
    #[error("{bound} is {value}, but no feedback gets below {floor:.4}; choose a larger bound")]
    BelowFloor {
        /// Key of the setting.
        bound: &'static str,
        /// Value of the setting.
        value: f64,
        /// The least value that is possible.
        floor: f64,
    },
    /// A design with dense matrices was used for a building that is too large for them.
    #[error("the {design} design has {found} unknowns for this building, at most {most}: use the distributed one")]
    TooManyUnknowns {
        /// Name of the design.
        design: &'static str,
        /// Number of unknowns that the design would need.
        found: usize,
        /// The largest number that is solved in reasonable time.
        most: usize,
    },
    /// The certificate of a design needs matrices that are too large for this building.
    #[error(
        "{certificate} is for at most {most} temperatures, and {zones} zones with their walls that store heat have {nodes}: \
         {remedy}"
    )]
    TooManyTemperatures {
        /// Name of the certificate.
        certificate: &'static str,
        /// What to state instead.
        remedy: &'static str,
        /// Number of zones.
        zones: usize,
        /// Number of temperatures, of zones and walls.
        nodes: usize,
        /// The largest number for which it is solved in reasonable time.
        most: usize,
    },
    /// No feedback has the stated decay rate.
    #[error(
        "`decay` is {decay}, but walls settle by a factor of {floor:.4} in a step whatever a feedback of the zones does, so \
         that it must be above that: leave it out for {works:.4}"
    )]
    DecayBelowFloor {
        /// The stated rate per step.
        decay: f64,
        /// The rate that no feedback goes below.
        floor: f64,
        /// A rate that works, the default.
        works: f64,
    },
    /// A feedback is certified with a slower decay rate than stated.
    #[error(
        "the certificate of the decay rate {wanted:.4} was not found ({reason}); the feedback has another one, of {certified:.4}"
    )]
    WeakerFeedback {
        /// The stated rate per step.
        wanted: f64,
        /// The rate that is certified.
        certified: f64,
        /// Why the wanted one was not found.
        reason: Box<ControlError>,
    },
    /// A feedback is unstable where the model is wrong by the stated share.
    #[error(
        "where the model is wrong by {:.0} %, the feedback would have the spectral radius {spectral_radius:.3}; {:.4} times its gain is \
         left",
        100.0 * error, share
    )]
    NotRobust {
        /// The stated error of the model, as a share.
        error: f64,
        /// The largest spectral radius with the whole gain.
        spectral_radius: f64,
        /// The share of the gain that is stable; 0 if none was found.
        share: f64,
    },
    /// A feedback lets inputs alternate, as with a model that is wrong.
    #[error(
        "the inputs of the feedback alternated between up and down, as with a model that is wrong; {share:.4} times its gain is left"
    )]
    AlternatingInputs {
        /// The share of the gain that is left.
        share: f64,
    },
    /// The feedback that was found is not stable.
    #[error("the feedback is not stable: its closed loop has the spectral radius {spectral_radius:.4}")]
    Unstable {
        /// Spectral radius of A − BK.
        spectral_radius: f64,
    },
    /// The distributed design needs forward Euler, which would be unstable.
    #[error("zones that exchange messages with their neighbours only plan with forward Euler: {0}")]
    Model(#[from] ModelError),
    /// No zone of the distributed design can solve its own problem.
    #[error(
        "none of the {zones} zones can solve its own problem in round {round}: their costs are not strictly convex, or \
         not finite; set `input_weight` above 0, and look for huge numbers in the forecast"
    )]
    NoZonePlans {
        /// Number of zones.
        zones: usize,
        /// The round of the exchange, from 1.
        round: usize,
    },
    /// A controller that plans at every step found no plan in one of them.
    #[error("step {step} has no plan of its own: {why}")]
    StepWithoutPlan {
        /// The step, counted from midnight.
        step: usize,
        /// Why no plan was found.
        why: Box<ControlError>,
    },
    /// The clairvoyant controller did not get the actual disturbance.
    #[error("the clairvoyant controller needs to be told the day's actual weather and occupancy")]
    NotClairvoyant,
    /// The day's optimum needs the model as matrices, and an exact model of this size has none.
    #[error(
        "the day's optimum is not available for the exact model of {nodes} temperatures, at most {most}: use \
         forward Euler"
    )]
    TooLarge {
        /// Number of temperatures of the network.
        nodes: usize,
        /// The largest number of temperatures with matrices.
        most: usize,
    },
    /// A plan over stages was not found.
    #[error(transparent)]
    Staged(#[from] StagedError),
    /// The optimisation problem is malformed.
    #[error("the day's optimum cannot be posed: {0}")]
    Problem(#[from] ProblemError),
    /// The optimisation problem was not solved.
    #[error("the optimisation has no result: {0}")]
    Solve(#[from] SolveError),
}

impl ControlError {
    /// Whether the controller had a plan in spite of the error.
    pub fn has_plan(&self) -> bool {
        matches!(self, Self::AlternatingInputs { .. })
    }

    /// What the controller did instead of planning, after the words "day 2" or "this day".
    pub fn consequence(&self) -> &'static str {
        match self {
            Self::StepWithoutPlan { .. } => "followed an older plan for some steps",
            Self::AlternatingInputs { .. } => "weakened its feedback",
            _ => "repeated the one before",
        }
    }

    /// The key of the setting at fault, in the table of the controller; `kind` if the kind of controller is.
    pub fn key(&self) -> SettingKey {
        match self {
            Self::Setting(error) => error.key.clone(),
            Self::BelowFloor { bound, .. } => (*bound).into(),
            Self::DecayBelowFloor { .. } => "decay".into(),
            Self::TooManyTemperatures { .. } => "stability".into(),
            Self::NotRobust { .. } => "model_error".into(),
            Self::TooManyUnknowns { design: "model-predictive", .. } => "horizon_h".into(),
            _ => "kind".into(),
        }
    }

    /// Refuses a series of the wrong length.
    pub(crate) fn check_length(what: &'static str, found: usize, wanted: usize) -> Result<(), Self> {
        if found == wanted { Ok(()) } else { Err(Self::Shape { what, found, wanted }) }
    }

    /// Refuses a series with a number that is not finite, or so large that a bias learned from it would never decay.
    pub(super) fn check_finite(what: &'static str, series: &[f64]) -> Result<(), Self> {
        match series
            .iter()
            .position(|value| !matches!(value.abs().partial_cmp(&MAX_TEMPERATURE_C_OR_HEAT_KW), Some(Ordering::Less)))
        {
            Some(index) => Err(Self::NotFinite { what, index, value: series[index] }),
            None => Ok(()),
        }
    }
}
