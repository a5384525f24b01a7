//! The declaration of a metric: all that reports, rows of sweeps, comparisons and expectations need to know about it.
//!
//! The simulation declares in the same place how a metric follows from the ticks of a run. This crate knows only the
//! declaration.

use std::any::Any;
use std::collections::BTreeSet;
use std::fmt::Debug;
use std::sync::Arc;

use interplay_common::units::{quantity_of, unit_of};

/// The declaration of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MetricDeclaration {
    /// Its name, which ends with its unit as the keys of settings do: the column in rows of sweeps, and its key in reports.
    pub name: &'static str,
    /// Its meaning, in one sentence without a full stop.
    pub doc: &'static str,
    /// The type of its value.
    pub kind: MetricKind,
    /// Whether each vehicle has a value of its own, or the run has one.
    pub of: MetricSubject,
    /// Its key in reports, if that is not its name.
    pub report_key: Option<&'static str>,
    /// How `compare` summarises the values of many runs; `None` if it leaves the metric out.
    pub comparison: Option<MetricComparison>,
    /// Its key in comparisons, if that is not its name.
    pub comparison_key: Option<&'static str>,
    /// Which of two values under the same conditions is better; `None` if neither is.
    pub better: Option<Better>,
    /// Whether rows, which are about the ego, also have a column `others_NAME` with the worst value of the others: any of flags,
    /// the sum of counts.
    pub others: bool,
}

/// The type of a metric's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetricKind {
    /// True or false.
    Flag,
    /// A whole number.
    Count,
    /// A number.
    Number,
}

/// The declaration of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetricSubject {
    /// Each vehicle; rows of sweeps have that of the ego.
    Vehicle,
    /// The run.
    Run,
}

/// How the values of many runs are summarised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetricComparison {
    /// The share of the runs in which a flag is true, with Wilson's interval.
    Share,
    /// The sum of counts.
    Sum,
    /// The mean of numbers, with a bootstrap interval.
    Mean,
    /// The minimum of numbers, their quantile at 5 % and their median: for gaps, and for other metrics whose small values are critical.
    Quantiles,
}

/// Which of two values is better; of two flags, `false` is the lower value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// The lower one.
    Lower,
    /// The higher one.
    Higher,
}

impl MetricDeclaration {
    /// A metric of each vehicle.
    pub const fn of_vehicle(name: &'static str, kind: MetricKind, doc: &'static str) -> Self {
        MetricDeclaration {
            name,
            doc,
            kind,
            of: MetricSubject::Vehicle,
            report_key: None,
            comparison: None,
            comparison_key: None,
            better: None,
            others: false,
        }
    }

    /// A metric of the run.
    pub const fn of_run(name: &'static str, kind: MetricKind, doc: &'static str) -> Self {
        MetricDeclaration { of: MetricSubject::Run, ..Self::of_vehicle(name, kind, doc) }
    }

    /// The same metric, summarised by `compare`.
    #[must_use]
    pub const fn compared(self, comparison: MetricComparison) -> Self {
        MetricDeclaration { comparison: Some(comparison), ..self }
    }

    /// The same metric, with a preferred direction.
    #[must_use]
    pub const fn better(self, better: Better) -> Self {
        MetricDeclaration { better: Some(better), ..self }
    }

    /// The same metric, with a column for the other vehicles.
    #[must_use]
    pub const fn with_others(self) -> Self {
        MetricDeclaration { others: true, ..self }
    }

    /// The unit of the metric, from the end of its name; `None` without a unit.
    pub fn unit(&self) -> Option<&'static str> {
        unit_of(self.name)
    }

    /// The name of the metric without its unit, such as `peak_braking`.
    pub fn quantity(&self) -> &'static str {
        quantity_of(self.name)
    }

    /// The end of the metric's name that stands for its unit, such as `mps2`; `value` without a unit.
    pub fn unit_key(&self) -> &'static str {
        self.name.strip_prefix(self.quantity()).and_then(|rest| rest.strip_prefix('_')).unwrap_or("value")
    }

    /// Its name, its key in reports, and the column of the others: the names that it reserves.
    pub(crate) fn keys(&self) -> BTreeSet<String> {
        let others = self.others.then(|| self.others_name());
        [Some(self.name), self.report_key].into_iter().flatten().map(str::to_owned).chain(others).collect()
    }

    /// The column of the worst value of the other vehicles.
    pub fn others_name(&self) -> String {
        format!("others_{}", self.name)
    }

    /// The key of the metric in comparisons.
    pub fn compared_as(&self) -> &'static str {
        self.comparison_key.unwrap_or(self.name)
    }
}

/// A metric as the scenario crate knows it: its declaration. The simulation downcasts the value to compute the metric.
pub trait DeclaredMetric: Any + Debug + Send + Sync {
    /// Its declaration.
    fn declaration(&self) -> MetricDeclaration;

    /// Its version, which distinguishes its values from those of earlier ones: rows of sweeps with another version are computed again.
    /// `None` for a metric of Interplay, whose own version does that.
    fn version(&self) -> Option<&'static str>;
}

/// Metrics that a registry knows.
#[derive(Clone, Debug, Default)]
pub struct RegisteredMetrics(pub Vec<Arc<dyn DeclaredMetric>>);

impl PartialEq for RegisteredMetrics {
    /// Metrics are equal if their declarations are.
    fn eq(&self, other: &Self) -> bool {
        self.0.iter().map(|one| one.declaration()).eq(other.0.iter().map(|one| one.declaration()))
    }
}
