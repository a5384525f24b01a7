//! Metrics of a run that are the minimum over ticks, with pair and time: gaps, and times to collision.

use interplay_scenarios::{MetricDeclaration, Scenario};

use super::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use super::values::{Measured, MetricValue};

/// The minimum over ticks of a value of the run.
#[derive(Clone, Copy, Debug)]
pub struct LeastOfRun {
    /// Its declaration.
    pub declaration: MetricDeclaration,
    /// The value of a tick; none if it has none. Only a value below the second argument is needed.
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

/// The minimum so far, with the time at which it was first reached.
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
