//! Metrics of a vehicle that fold a value at each tick over the run: peaks, extremes, means, and
//! flags.

use interplay_scenarios::{MetricDeclaration, Scenario, Vehicle};

use super::metric::{Measurement, Metric, Needs, ObservedMoment, ObservedTick, VehicleMoment, VehicleTick};
use super::values::{Measured, MetricValue};

/// A metric of each vehicle: a value at each tick, and the fold over all ticks.
#[derive(Clone, Copy, Debug)]
pub struct VehicleMetric {
    /// Its declaration.
    pub declaration: MetricDeclaration,
    /// The value at each tick.
    pub quantity: VehicleQuantity,
    /// The fold over all ticks.
    pub fold: Fold,
    /// Whether a vehicle has a value.
    pub applies: fn(&Vehicle) -> bool,
}

/// The quantity of a vehicle that the metric measures at each tick; `None` if the vehicle has no value.
#[derive(Clone, Copy, Debug)]
pub enum VehicleQuantity {
    /// A value of the tick as a whole; its time is the beginning of the tick.
    OverTick(fn(&VehicleTick<'_>) -> Option<f64>),
    /// A value of the vehicle at the start and after each tick.
    AtMoment(fn(&VehicleMoment<'_>) -> Option<f64>),
}

/// How the values of all ticks are combined into one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fold {
    /// The largest positive value, with the time at which it was first reached; 0 if none was positive.
    Peak,
    /// The smallest value.
    Least,
    /// The largest value.
    Largest,
    /// The mean; 0 without values.
    Mean,
    /// The number of values that are not 0; for a flag, whether any is set.
    Count,
}

impl VehicleMetric {
    /// A metric that every vehicle has.
    pub const fn new(declaration: MetricDeclaration, fold: Fold, quantity: VehicleQuantity) -> Self {
        VehicleMetric { declaration, quantity, fold, applies: |_| true }
    }
}

impl Metric for VehicleMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn begin(&self, _: &Scenario, start: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        let value = match self.fold {
            Fold::Least => f64::INFINITY,
            Fold::Largest => f64::NEG_INFINITY,
            Fold::Peak | Fold::Mean | Fold::Count => 0.0,
        };
        let moment = start.of(vehicle);
        let applies = (self.applies)(moment.vehicle);
        let mut folded = FoldedMetric { metric: *self, vehicle, applies, value, time_s: None, count: 0 };
        if let VehicleQuantity::AtMoment(quantity) = self.quantity {
            folded.take(quantity(&moment), start.time_s);
        }
        Box::new(folded)
    }

    fn needs(&self) -> Needs {
        Needs::STATES
    }
}

#[derive(Clone, Copy, Debug)]
struct FoldedMetric {
    metric: VehicleMetric,
    vehicle: usize,
    applies: bool,
    /// The folded value; for a mean, the sum.
    value: f64,
    /// Time at which a peak was first reached \[s\].
    time_s: Option<f64>,
    count: usize,
}

impl FoldedMetric {
    fn take(&mut self, number: Option<f64>, time_s: f64) {
        let Some(number) = number else { return };
        self.count += 1;
        match self.metric.fold {
            Fold::Peak if number > self.value => (self.value, self.time_s) = (number, Some(time_s)),
            Fold::Peak => {}
            Fold::Least => self.value = self.value.min(number),
            Fold::Largest => self.value = self.value.max(number),
            Fold::Mean => self.value += number,
            Fold::Count => self.value += f64::from(number != 0.0),
        }
    }
}

impl Measurement for FoldedMetric {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        match self.metric.quantity {
            VehicleQuantity::OverTick(quantity) => self.take(quantity(&tick.of(self.vehicle)), tick.frame.time_s),
            VehicleQuantity::AtMoment(quantity) => self.take(quantity(&tick.end.of(self.vehicle)), tick.end.time_s),
        }
    }

    fn measured(&self) -> Measured {
        let is_extreme = matches!(self.metric.fold, Fold::Least | Fold::Largest);
        let value = match self.metric.fold {
            Fold::Mean => self.value / self.count.max(1) as f64,
            _ => self.value,
        };
        let value = Some(value).filter(|_| self.applies && (self.count > 0 || !is_extreme));
        let is_peak = self.metric.fold == Fold::Peak;
        Measured { time_s: self.time_s, is_peak, ..Measured::number(value).of_kind(self.metric.declaration.kind) }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}

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
