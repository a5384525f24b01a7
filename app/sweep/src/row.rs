//! One run of a sweep as a row of plain values.

use std::collections::BTreeMap;

use interplay_scenarios::SweepPoint;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use crate::key::RunKey;

/// One run. Only the last three values differ when it is made again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Digest of all that decides the result.
    pub key: RunKey,
    /// The version of the program.
    pub version: String,
    /// The scenario's name.
    pub scenario: String,
    /// The scenario's family.
    pub family: String,
    /// Who drives the other vehicles, as the plan names it.
    pub style: String,
    /// Who drives the ego, as the plan names it.
    pub planner: String,
    /// The sample: rows of one scenario, style and sample are a pair for two planners.
    pub sample: u64,
    /// The seed of the run.
    pub seed: u64,
    /// What varies, by its path.
    pub inputs: BTreeMap<String, Json>,
    /// Why there is no result.
    pub error: Option<String>,
    /// The result; none with an error.
    #[serde(default)]
    pub result: Option<RunResult>,
    /// Wall time of the run \[s\]; not reproducible.
    pub wall_s: f64,
    /// Median time of the ego's plans \[ms\]; not reproducible.
    pub plan_median_ms: Option<f64>,
    /// 99th percentile of the times of the ego's plans \[ms\]; not reproducible.
    pub plan_p99_ms: Option<f64>,
}

/// What a run amounts to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Digest of all states, bit for bit.
    pub digest: String,
    /// Simulated time \[s\].
    pub simulated_s: f64,
    /// Whether every expectation of the scenario held. They are about the drivers that its file states.
    pub passed: bool,
    /// What was measured of vehicles, by the names of the columns; none without any.
    pub traffic: Option<BTreeMap<String, Json>>,
    /// What was measured of a building, by the names of the columns; none without one.
    pub building: Option<BTreeMap<String, Json>>,
}

impl SweepRow {
    /// The same result as a row of another run of the same key: another plan, or another arm of the plan that changes the same, may
    /// have made it.
    #[must_use]
    pub(crate) fn labelled(self, point: SweepPoint) -> SweepRow {
        let SweepPoint { scenario, family, style, planner, sample, seed, inputs, .. } = point;
        SweepRow { scenario, family, style, planner, sample, seed, inputs: inputs.into_iter().collect(), ..self }
    }

    /// Whether the run is worth looking at: it has no result, or the ego did not do its task without contact; without vehicles,
    /// an expectation failed.
    pub fn is_failure(&self) -> bool {
        self.result.as_ref().is_none_or(|result| match &result.traffic {
            Some(traffic) => traffic.get("success") != Some(&Json::Bool(true)),
            None => !result.passed,
        })
    }
}
