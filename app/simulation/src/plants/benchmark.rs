//! The indicators of a completed benchmark test.

use std::collections::BTreeMap;

use interplay_building::benchmark::Indicators;
use serde::Serialize;

/// The indicators of a completed test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Benchmark {
    /// The indicators that BOPTEST computed, by its names; an indicator that the case does not have is `null`.
    pub official: BTreeMap<String, Option<f64>>,
    /// The indicators that we computed from the same measurements; none without `building.plant.indicators`.
    pub ours: Option<Indicators>,
    /// Mean share of a step between an answer and the next request, by the clock.
    pub time_ratio: Option<f64>,
}

impl Benchmark {
    /// Combines BOPTEST's indicators, by name, with ours. `control_s` is the duration of each decision.
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
