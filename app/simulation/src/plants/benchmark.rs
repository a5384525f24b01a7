//! The indicators of a benchmark whose test is over.

use std::collections::BTreeMap;

use interplay_building::benchmark::Indicators;
use serde::Serialize;

/// The indicators of a test that is over.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Benchmark {
    /// What BOPTEST computed, by its names; an indicator that the case does not have is `null`.
    pub official: BTreeMap<String, Option<f64>>,
    /// What we computed from the same measurements; none without `building.plant.indicators`.
    pub ours: Option<Indicators>,
    /// Mean share of a step that passed between an answer and the next request. By the clock.
    pub time_ratio: Option<f64>,
}

impl Benchmark {
    /// Puts the indicators together: BOPTEST's by their names, and ours. `control_s` is how long each decision took.
    pub fn new(
        official: BTreeMap<String, Option<f64>>,
        ours: Option<Indicators>,
        control_s: &[f64],
        step_s: f64,
    ) -> Self {
        let time_ratio = Indicators::computational_time_ratio(control_s, step_s);
        Self { official, ours, time_ratio }
    }
}
