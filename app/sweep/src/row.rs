//! One run of a sweep as a row of plain values.

use std::collections::BTreeMap;

use interplay_scenarios::SweepPoint;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use crate::key::RunKey;

/// One run. Only the last three values differ when the run is repeated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Digest of all that determines the result.
    pub key: RunKey,
    /// The version of the program.
    pub version: String,
    /// The scenario's name.
    pub scenario: String,
    /// The scenario's family.
    pub family: String,
    /// The driver of the other vehicles, by its name in the plan.
    pub style: String,
    /// The driver of the ego, by its name in the plan.
    pub planner: String,
    /// The sample: rows of one scenario, style and sample form a pair for two planners.
    pub sample: u64,
    /// The seed of the run.
    pub seed: u64,
    /// The varied inputs, by path.
    pub inputs: BTreeMap<String, Json>,
    /// The reason for a missing result.
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

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Digest of all states, bit for bit.
    pub digest: String,
    /// Simulated time \[s\].
    pub simulated_s: f64,
    /// Whether every expectation of the scenario held. Expectations concern the drivers that its file states.
    pub passed: bool,
    /// Measured values of the vehicles, by column; none without vehicles.
    pub traffic: Option<BTreeMap<String, Json>>,
    /// Measured values of the building, by column; none without a building.
    pub building: Option<BTreeMap<String, Json>>,
}

impl SweepRow {
    /// The same result as a row of another run with the same key: another plan, or another variant of the plan with the same changes, may
    /// have made it.
    #[must_use]
    pub(crate) fn labelled(self, point: SweepPoint) -> SweepRow {
        let SweepPoint { scenario, family, style, planner, sample, seed, inputs, .. } = point;
        SweepRow { scenario, family, style, planner, sample, seed, inputs: inputs.into_iter().collect(), ..self }
    }

    /// Whether the run failed: it has no result, or the ego did not complete its task without
    /// contact; without vehicles, an expectation failed.
    pub fn is_failure(&self) -> bool {
        self.result.as_ref().is_none_or(|result| match &result.traffic {
            Some(traffic) => traffic.get("success") != Some(&Json::Bool(true)),
            None => !result.passed,
        })
    }
}
