//! Which metrics a run measures: those that Interplay has, and those that a registry brought along.

use std::any::Any;

use interplay_scenarios::{DeclaredMetric, MetricDeclaration, RegisteredMetrics};

use super::metric::Metric;
use super::metrics;

/// A metric as the loader knows it; the way back to what computes it is its type.
#[derive(Debug)]
struct RegisteredMetric(Box<dyn Metric>);

impl DeclaredMetric for RegisteredMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.0.declaration()
    }
}

/// All metrics that are measured, in their order: those that Interplay has, and then the registered ones.
pub fn metrics_of(registered: &RegisteredMetrics) -> impl Iterator<Item = &dyn Metric> {
    let own = || metrics::ALL.iter().copied().flatten().copied();
    let registered = registered.0.iter().filter_map(|metric| {
        let any: &dyn Any = &**metric;
        any.downcast_ref::<RegisteredMetric>().map(|metric| &*metric.0)
    });
    let is_new = move |metric: &&dyn Metric| own().all(|own| own.declaration().name != metric.declaration().name);
    own().chain(registered.filter(is_new))
}
