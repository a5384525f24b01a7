//! The number of rules of the road that a vehicle breaks ([`RuleWatch`](crate::measure::RuleWatch) finds them).

use interplay_scenarios::MetricKind::Count;
use interplay_scenarios::{MetricComparison, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};

const DOC: &str = "How often it breaks a rule of the road: passes a red light, or a stop sign without standing, \
                   takes another vehicle's right of way, or exceeds a speed limit";

pub(super) const METRICS: &[&dyn Metric] = &[&RulesBroken];

#[derive(Clone, Copy, Debug)]
struct RulesBroken;

impl Metric for RulesBroken {
    fn declaration(&self) -> MetricDeclaration {
        MetricDeclaration::of_vehicle("rules_broken", Count, DOC).compared(MetricComparison::Sum).with_others()
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(BrokenSoFar { vehicle, count: 0 })
    }
}

/// The rules that one vehicle has broken so far.
#[derive(Clone, Copy, Debug)]
struct BrokenSoFar {
    vehicle: usize,
    count: usize,
}

impl Measurement for BrokenSoFar {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let name = tick.frame.vehicles.get(self.vehicle).map(|vehicle| &vehicle.name);
        self.count += tick.frame.broken_rules.iter().filter(|broken| Some(&broken.vehicle) == name).count();
    }

    fn measured(&self) -> Measured {
        Measured { value: Some(MetricValue::Count(self.count as u64)), ..Measured::default() }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}
