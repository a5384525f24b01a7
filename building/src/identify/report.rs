//! What an identification found, ready for a table, a plot or JSON.

use schemars::JsonSchema;
use serde::Serialize;

use super::diagnostics::{ParameterVerdict, Whiteness};
use super::free_run::ResidualForecast;
use super::identified_network::IdentifiedNetwork;
use super::{Arma, Estimator};

/// An identification: what to say, and what to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// What to say.
    pub report: IdentificationReport,
    /// What to draw, one a zone.
    pub series: Vec<ZoneSeries>,
    /// The network for a scenario, or why there is none.
    pub network: Result<IdentifiedNetwork, String>,
}

/// What an identification found.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct IdentificationReport {
    /// The estimator.
    pub method: Estimator,
    /// Sampling time \[s\].
    pub step_s: f64,
    /// Rows used, and of them those trained on.
    pub rows: usize,
    /// Rows trained on.
    pub train_rows: usize,
    /// Rows left out because a value was missing.
    pub left_out_rows: usize,
    /// Into how many pieces gaps and batches divide the rows.
    pub segments: usize,
    /// The zones.
    pub zones: Vec<ZoneReport>,
    /// Walls between two zones, seen from both.
    pub walls: Vec<WallReport>,
    /// The models that were compared to choose the order, by `state-space`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<ModelRow>,
    /// Everything that a reader must know before using a number.
    pub warnings: Vec<String>,
}

/// A model that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ModelRow {
    /// Its hidden nodes in words; `air alone` without any.
    pub model: String,
    /// States of a zone, at most.
    pub states: usize,
    /// Number of parameters.
    pub parameters: usize,
    /// Log-likelihood at the estimate.
    pub log_likelihood: f64,
    /// Twice the gain over the model that it extends, and how probable so large a gain is if that one is right.
    pub gain: Option<(f64, f64)>,
    /// Whether it is the one that was chosen.
    pub chosen: bool,
}

/// What was found of a zone.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ZoneReport {
    /// Its name.
    pub name: String,
    /// The coefficients of eq. 2.3: b_ik, a_i, s_i; none by `state-space`.
    pub coefficients: Vec<Quantity>,
    /// What they mean: capacity, conductances, resistances, aperture, time constant, gains.
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

/// A number with its uncertainty and what to think of it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Quantity {
    /// What it is, as `conductance to outdoor`.
    pub name: String,
    /// The symbol of the source, as `b`.
    pub symbol: String,
    /// Its unit.
    pub unit: String,
    /// The estimate; `None` where the data do not determine it.
    pub value: Option<f64>,
    /// Its standard error; `None` where the data do not determine it.
    pub standard_error: Option<f64>,
    /// Interval of 95 %; `None` for an end that is unbounded.
    pub interval: (Option<f64>, Option<f64>),
    /// Whether the data determine it.
    pub verdict: ParameterVerdict,
    /// What other ways of estimating it give; for coefficients only.
    pub checks: Vec<CrossCheck>,
}

/// Another estimate of a coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CrossCheck {
    /// How it was obtained, as `by semiparametric`.
    pub how: String,
    /// The estimate before the condition that it is not negative; `None` where it is not determined.
    pub value: Option<f64>,
    /// Its standard error; `None` where it is not determined.
    pub standard_error: Option<f64>,
}

/// The model of the non-parametric term q \[K per step\].
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ResidualReport {
    /// As in the source (2.12): ψ, α, and the moving average.
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
    /// Free runs.
    pub free_run: FreeRunReport,
}

/// Errors of free runs.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FreeRunReport {
    /// How long each run is \[h\].
    pub horizon_h: f64,
    /// How many runs fit into the rows.
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
    /// The zones.
    pub between: (String, String),
    /// Conductance with standard error from the first \[kW/K\].
    pub from_first: Option<(f64, f64)>,
    /// The same from the second.
    pub from_second: Option<(f64, f64)>,
    /// Both, weighted by their precision, if they agree.
    pub combined: Option<(f64, f64)>,
    /// In words.
    pub words: String,
}

/// What to draw of a zone. Every series has one value a row.
#[derive(Debug, Clone, PartialEq)]
pub struct ZoneSeries {
    /// Its name.
    pub name: String,
    /// Time since the midnight before the first row \[s\].
    pub time_s: Vec<f64>,
    /// Where a segment begins, so that no line is drawn across a gap.
    pub segment_starts: Vec<usize>,
    /// The first row that was not trained on.
    pub test_start: usize,
    /// Measured temperature \[°C\].
    pub measured_c: Vec<f64>,
    /// Predicted one step ahead \[°C\].
    pub one_step_c: Vec<f64>,
    /// Free run of the network alone, from the measured temperature anew every horizon \[°C\].
    pub free_run_c: Vec<f64>,
    /// The same with daily profile and ARMA; `None` by `state-space`.
    pub free_run_with_residual_model_c: Option<Vec<f64>>,
    /// Innovations \[K\]; NaN where there is none.
    pub innovations_k: Vec<f64>,
}
