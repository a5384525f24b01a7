//! Metrics of a run that are the least of a number at each tick, with whom and when: gaps, and times to collision.

use interplay_scenarios::{MetricDeclaration, Scenario};

use super::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use super::values::{Measured, MetricValue};

/// The least of a number that a run has at each tick.
#[derive(Clone, Copy, Debug)]
pub struct LeastOfRun {
    /// What is said of it.
    pub declaration: MetricDeclaration,
    /// The number of a tick; none where it has none. Only one below the second argument is of interest.
    pub quantity: fn(&ObservedTick<'_>, f64) -> Option<Measured>,
}

impl Metric for LeastOfRun {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, _: usize) -> Box<dyn Measurement> {
        Box::new(LeastSoFar { metric: *self, least: Measured::default() })
    }
}

/// The least one so far, when it was reached first.
#[derive(Clone, Debug)]
struct LeastSoFar {
    metric: LeastOfRun,
    least: Measured,
}

impl Measurement for LeastSoFar {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let number = |measured: &Measured| measured.value.map_or(f64::INFINITY, MetricValue::as_number);
        let below = number(&self.least);
        if let Some(found) = (self.metric.quantity)(tick, below).filter(|found| number(found) < below) {
            self.least = found;
        }
    }

    fn measured(&self) -> Measured {
        self.least.clone()
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}
