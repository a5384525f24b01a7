//! The results of an identification, ready for a table, a plot or JSON.

use schemars::JsonSchema;
use serde::Serialize;

use super::diagnostics::{ParameterVerdict, Whiteness};
use super::free_run::ResidualForecast;
use super::{Arma, Estimator};
use crate::network::{Wall, Zone};

/// The result of an identification: the report, the series to draw, and the network.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// The report.
    pub report: IdentificationReport,
    /// The series to draw, one for each zone.
    pub series: Vec<ZoneSeries>,
    /// The network for a scenario, or why there is none.
    pub network: Result<IdentifiedNetwork, String>,
}

/// The report of an identification.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct IdentificationReport {
    /// The estimator that was used.
    pub method: Estimator,
    /// Sampling time \[s\].
    pub step_s: f64,
    /// Number of rows that were used, for training and testing.
    pub rows: usize,
    /// Number of rows that were trained on.
    pub train_rows: usize,
    /// Number of rows that were left out because a value was missing.
    pub left_out_rows: usize,
    /// Number of pieces into which gaps and batches divide the rows.
    pub segments: usize,
    /// The reports of the zones.
    pub zones: Vec<ZoneReport>,
    /// Walls between two zones, seen from both.
    pub walls: Vec<WallReport>,
    /// The models that were compared to choose the order, by `state-space`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<ModelRow>,
    /// Assumptions of every model that the data contradict, the cause that explains most first, by `state-space`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub suspicions: Vec<Suspicion>,
    /// Warnings that a reader must know before using a number.
    pub warnings: Vec<String>,
}

/// An assumption that the data contradict, with a probable cause.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Suspicion {
    /// The zone, if it is of one.
    pub zone: Option<String>,
    /// The probable cause.
    pub cause: SuspectedCause,
    /// By how much the log-likelihood is higher if the cause is allowed for.
    pub explains: f64,
    /// The same in words, with the figures.
    pub words: String,
}

/// A probable cause of a contradiction between data and model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SuspectedCause {
    /// The weather's clock is not that of the building.
    Clock,
    /// The sun comes from another side than the measured one.
    Sun,
    /// Unmeasured heat enters at the same hours each day, or when people are present.
    People,
    /// Heat is lost at times, as through open windows.
    Windows,
    /// The heat is recorded at another time than it is given.
    LateHeat,
    /// A recorded kilowatt heats more or less by the outdoor temperature, as if electricity of a heat pump were recorded.
    VaryingGain,
    /// The two halves of the record contradict each other.
    Halves,
}

/// A model that was tried by the method `state-space`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ModelRow {
    /// Hidden nodes of the model in words; `air alone` without any.
    pub model: String,
    /// Largest number of states of a zone.
    pub states: usize,
    /// Number of parameters.
    pub parameters: usize,
    /// Log-likelihood at the estimate.
    pub log_likelihood: f64,
    /// Twice the gain of log-likelihood over the model that it extends, and the probability of such a gain if the smaller model is right.
    pub gain: Option<(f64, f64)>,
    /// Whether it is worse than the model that it extends, which it contains: its best parameters were not found.
    pub search_failed: bool,
    /// Whether this model was chosen.
    pub chosen: bool,
}

/// The estimates for one zone, and how well they predict.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ZoneReport {
    /// Name of the zone.
    pub name: String,
    /// The coefficients of eq. 2.3: b_ik, a_i, s_i; none by `state-space`.
    pub coefficients: Vec<Quantity>,
    /// The physical meaning of the coefficients: capacity, conductances, resistances, aperture, time constant, gains.
    pub physical: Vec<Quantity>,
    /// Correlations of the coefficients' estimates, `None` where a coefficient is not determined.
    pub correlations: Vec<Vec<Option<f64>>>,
    /// Condition number of the scaled normal equations; `None` if they are singular.
    pub condition_number: Option<f64>,
    /// The model of the non-parametric term; `None` by `state-space`, which has none.
    pub residual_model: Option<ResidualReport>,
    /// Whether what that model leaves is white, on the training rows.
    pub whiteness: Whiteness,
    /// Errors on the training rows.
    pub train: ErrorReport,
    /// Errors on the test rows, if there are any.
    pub test: Option<ErrorReport>,
}

/// An estimated number with its uncertainty and a verdict.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Quantity {
    /// Name of the quantity, as `conductance to outdoor`.
    pub name: String,
    /// The symbol of the dissertation, as `b`.
    pub symbol: String,
    /// Unit of the value.
    pub unit: String,
    /// The estimate; `None` where the data do not determine it.
    pub value: Option<f64>,
    /// Standard error of the estimate; `None` where the data do not determine it.
    pub standard_error: Option<f64>,
    /// Interval of 95 %; `None` for an end that is unbounded.
    pub interval: (Option<f64>, Option<f64>),
    /// Whether the data determine the quantity.
    pub verdict: ParameterVerdict,
    /// Other estimates of the same quantity; for coefficients only.
    pub checks: Vec<CrossCheck>,
}

/// Another estimate of a coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CrossCheck {
    /// How the estimate was obtained, as `by semiparametric`.
    pub how: String,
    /// The estimate before the condition that it is not negative; `None` where it is not determined.
    pub value: Option<f64>,
    /// Standard error of the estimate; `None` where it is not determined.
    pub standard_error: Option<f64>,
}

/// The model of the non-parametric term q \[K per step\].
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ResidualReport {
    /// The constant ψ of the dissertation's form (2.12).
    pub psi: f64,
    /// ARMA with the constant.
    pub constant: Arma,
    /// ARMA about the daily profile.
    pub profile: Arma,
}

/// How well a zone's model predicts some rows \[K, root mean square\].
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ErrorReport {
    /// One step ahead: by `state-space` from all that was measured before, otherwise from the row before by the network alone.
    pub one_step_k: f64,
    /// One step ahead, with daily profile and ARMA; `None` by `state-space`.
    pub one_step_with_residual_model_k: Option<f64>,
    /// Errors of free runs.
    pub free_run: FreeRunReport,
}

/// Errors of free runs.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FreeRunReport {
    /// Length of each run \[h\].
    pub horizon_h: f64,
    /// Number of runs that fit into the rows.
    pub runs: usize,
    /// Root mean square error by forecast of the non-parametric term \[K\]; `None` without a run.
    pub errors_k: Vec<(ResidualForecast, Option<f64>)>,
    /// Root mean square error of the mean of the data over the same rows \[K\]; `None` without a run, and where it is not
    /// compared.
    pub mean_of_data_k: Option<f64>,
}

/// A wall between two zones, whose conductance both sides estimate.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct WallReport {
    /// The names of the two zones.
    pub between: (String, String),
    /// Conductance with standard error, estimated from the first zone \[kW/K\].
    pub from_first: Option<(f64, f64)>,
    /// Conductance with standard error, estimated from the second zone \[kW/K\].
    pub from_second: Option<(f64, f64)>,
    /// Mean of both estimates, weighted by their precision, if they agree.
    pub combined: Option<(f64, f64)>,
    /// The result in words.
    pub words: String,
}

/// The series of a zone to draw. Every series has one value a row.
#[derive(Debug, Clone, PartialEq)]
pub struct ZoneSeries {
    /// Name of the zone.
    pub name: String,
    /// Time since the midnight before the first row \[s\].
    pub time_s: Vec<f64>,
    /// Rows at which a segment begins, so that no line is drawn across a gap.
    pub segment_starts: Vec<usize>,
    /// The first row that was not trained on.
    pub test_start: usize,
    /// Measured temperature \[°C\].
    pub measured_c: Vec<f64>,
    /// Temperature predicted one step ahead \[°C\].
    pub one_step_c: Vec<f64>,
    /// Free run of the network alone, from the measured temperature anew every horizon \[°C\].
    pub free_run_c: Vec<f64>,
    /// Free run with daily profile and ARMA; `None` by `state-space` \[°C\].
    pub free_run_with_residual_model_c: Option<Vec<f64>>,
    /// Innovations \[K\]; NaN where there is none.
    pub innovations_k: Vec<f64>,
}

/// An identified network with its uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedNetwork {
    /// The zones, as estimated; the limits are the largest heat that was measured.
    pub zones: Vec<Zone>,
    /// The walls, as estimated; the first boundary, and any other, is the air outside.
    pub walls: Vec<Wall>,
    /// The uncertainty of the estimates.
    pub uncertainty: NetworkUncertainty,
    /// Mean temperature of the zones and of the first boundary over the record \[°C\].
    pub mean_c: (f64, Option<f64>),
    /// Remarks that a reader must know before using the network.
    pub remarks: Vec<String>,
}

/// Ends of 95 % intervals as multiples of the estimates; of several zones or walls the widest one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkUncertainty {
    /// Interval of heat capacities.
    pub capacity: (f64, f64),
    /// Interval of resistances between zones.
    pub inner_resistance: (f64, f64),
    /// Interval of resistances to the air outside.
    pub outer_resistance: (f64, f64),
}
