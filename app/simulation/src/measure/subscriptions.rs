//! What a run measures: everything, or what its caller subscribes to.
//!
//! A run with a report measures everything. An environment reads the contacts, a few metrics of its agents, and their progress; other
//! measures would cost as much as the vehicles' motion.

use super::metric::{Metric, Needs};

/// The measures to which a run subscribes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Subscriptions(Option<Selected>);

/// Some metrics of some vehicles.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Selected {
    metrics: Vec<&'static str>,
    vehicles: Vec<usize>,
}

impl Subscriptions {
    /// Everything, as a report needs it.
    pub fn everything() -> Self {
        Subscriptions(None)
    }

    /// The contacts, the states and their digest, the place of each vehicle on its route, and of these vehicles, which are indices in the
    /// scenario's order, these metrics and whether they reach their goals. A report of such a run has nothing else: no other metrics,
    /// no passages, waits, plans and beliefs, and no digests of the other phases.
    pub fn only(metrics: &[&'static str], vehicles: &[usize]) -> Self {
        Subscriptions(Some(Selected { metrics: metrics.to_vec(), vehicles: vehicles.to_vec() }))
    }

    /// Whether everything is measured.
    pub fn is_everything(&self) -> bool {
        self.0.is_none()
    }

    /// Whether a vehicle is among those that are measured.
    pub(super) fn has(&self, vehicle: usize) -> bool {
        self.0.as_ref().is_none_or(|selected| selected.vehicles.contains(&vehicle))
    }

    /// Whether a metric of a vehicle is measured; of a metric of the run, `vehicle` is the ego.
    pub(super) fn includes(&self, metric: &dyn Metric, vehicle: usize) -> bool {
        self.0
            .as_ref()
            .is_none_or(|selected| self.has(vehicle) && selected.metrics.contains(&metric.declaration().name))
    }

    /// What the measurements of a run need together, of all `metrics`.
    pub(crate) fn needs<'a>(&self, metrics: impl Iterator<Item = &'a dyn Metric>) -> Needs {
        let Some(Selected { metrics: names, .. }) = &self.0 else { return Needs::EVERYTHING };
        let subscribed = metrics.filter(|metric| names.contains(&metric.declaration().name));
        subscribed.fold(Needs::STATES, |needs, metric| needs.and(metric.needs()))
    }
}
