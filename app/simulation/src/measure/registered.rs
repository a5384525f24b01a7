//! The metrics of a run: those of Interplay, and those that a registry adds.

use std::any::Any;
use std::sync::Arc;

use interplay_scenarios::{DeclaredMetric, MetricDeclaration, RegisteredMetrics, Registry, RegistryError};

use super::metric::Metric;
use super::metrics;

/// Keys of reports and of their vehicles, and suffixes of columns, that no metric may use.
const TAKEN: [&str; 10] = [
    "scenario",
    "seed",
    "name",
    "driver",
    "final",
    "standing",
    "beliefs",
    "peak_times_s",
    "plan_median_ms",
    "plan_p99_ms",
];

/// A metric as a registry stores it; its type leads back to the computation.
#[derive(Debug)]
enum KnownMetric {
    /// A metric of Interplay.
    Own(&'static dyn Metric),
    /// A metric of another crate.
    Foreign(Box<dyn Metric>),
}

impl KnownMetric {
    fn metric(&self) -> &dyn Metric {
        match self {
            KnownMetric::Own(metric) => *metric,
            KnownMetric::Foreign(metric) => &**metric,
        }
    }
}

impl DeclaredMetric for KnownMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.metric().declaration()
    }

    fn version(&self) -> Option<&'static str> {
        match self {
            KnownMetric::Own(_) => None,
            KnownMetric::Foreign(metric) => Some(metric.version()),
        }
    }
}

/// Adds metrics to a registry.
pub trait RegisterMetrics: Sized {
    /// The same registry with the metrics of Interplay declared, so that the names in expectations are checked when a
    /// scenario is loaded.
    ///
    /// # Errors
    /// [`RegistryError::MetricTaken`] if another crate has declared one of them.
    fn with_own_metrics(self) -> Result<Self, RegistryError>;

    /// The same registry with an additional metric of another crate: `run` reports it, `sweep` has a column for it,
    /// `compare` compares it, and `[[expect.metric]]` may bound it.
    ///
    /// # Errors
    /// [`RegistryError::MetricTaken`] if its name or one of its keys is taken.
    fn with_metric(self, metric: impl Metric + 'static) -> Result<Self, RegistryError>;
}

impl RegisterMetrics for Registry {
    fn with_own_metrics(self) -> Result<Self, RegistryError> {
        if self.metrics().0.iter().any(|metric| metric.version().is_none()) {
            return Ok(self);
        }
        own().try_fold(self, |registry, metric| registry.with_declared_metric(Arc::new(KnownMetric::Own(metric))))
    }

    fn with_metric(self, metric: impl Metric + 'static) -> Result<Self, RegistryError> {
        let name = metric.declaration().name;
        if TAKEN.contains(&name) {
            return Err(RegistryError::MetricTaken(name.to_owned()));
        }
        self.with_own_metrics()?.with_declared_metric(Arc::new(KnownMetric::Foreign(Box::new(metric))))
    }
}

fn own() -> impl Iterator<Item = &'static dyn Metric> {
    metrics::ALL.iter().copied().flatten().copied()
}

/// All metrics of a run, in order: those of Interplay, then the registered ones of other crates.
pub fn metrics_of(registered: &RegisteredMetrics) -> impl Iterator<Item = &dyn Metric> {
    let foreign = registered.0.iter().filter_map(|metric| {
        let any: &dyn Any = &**metric;
        match any.downcast_ref::<KnownMetric>()? {
            KnownMetric::Own(_) => None,
            KnownMetric::Foreign(metric) => Some(&**metric),
        }
    });
    own().map(|metric| -> &dyn Metric { metric }).chain(foreign)
}
