//! The metrics of a run: those of Interplay, and those that a registry adds.

use std::any::Any;
use std::sync::Arc;

use interplay_scenarios::{
    Better, DeclaredMetric, MetricComparison, MetricDeclaration, MetricKind, MetricSubject, RegisteredMetrics,
    Registry, RegistryError,
};

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
    Own(&'static dyn Metric),
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

const HEAD: &str = "# Every metric\n\n\
    This page is made of what the metrics declare of themselves.\n\n\
    - *Name*: the column in rows of [sweeps](../guide/sweeps.md), which of a metric of vehicles has the value of the ego; the name in\n  \
    `[[expect.metric]]`; and without another *key*, the key in the [report](../guide/output.md), below `vehicles[]` if each vehicle has a\n  \
    value of its own.\n\
    - *Unit*: none for flags, counts, and shares.\n\
    - *Compared*: what `interplay compare` tells. Of pairs of runs it counts which has the better value where a direction is\n  \
    stated. A metric with *others* has a second column, `others_NAME`: the worst value of the other vehicles.\n\n";

/// The reference page of all metrics as Markdown.
pub fn metric_table(registered: &RegisteredMetrics) -> String {
    let mut page = format!("{HEAD}| name | of | key | unit | compared | what |\n|---|---|---|---|---|---|\n");
    for declaration in metrics_of(registered).map(|metric| metric.declaration()) {
        page += &row(&declaration);
    }
    page
}

fn row(declaration: &MetricDeclaration) -> String {
    let MetricDeclaration { name, doc, kind, of, report_key, comparison, better, others, .. } = declaration;
    let of = match of {
        MetricSubject::Run => "the run",
        MetricSubject::Vehicle => "vehicles",
    };
    let unit = match (declaration.unit(), kind) {
        (Some(unit), _) => unit,
        (None, MetricKind::Flag) => "true or false",
        (None, MetricKind::Count | MetricKind::Number) => "",
    };
    let comparison = comparison.map(|comparison| match comparison {
        MetricComparison::Share => "share",
        MetricComparison::Sum => "sum",
        MetricComparison::Mean => "mean",
        MetricComparison::Quantiles => "quantiles",
    });
    let better = better.filter(|_| comparison.is_some()).map(|better| match better {
        Better::Lower => "lower is better",
        Better::Higher => "higher is better",
    });
    let compared: Vec<&str> = comparison.into_iter().chain(better).chain(others.then_some("others")).collect();
    let key = report_key.map_or_else(String::new, |key| format!("`{key}`"));
    format!("| `{name}` | {of} | {key} | {unit} | {} | {doc} |\n", compared.join(", "))
}
