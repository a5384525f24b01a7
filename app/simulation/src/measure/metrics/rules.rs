//! How often a vehicle breaks a rule of the road ([`BrokenRules`](crate::measure::BrokenRules) has the rules).

use interplay_scenarios::MetricKind::Count;
use interplay_scenarios::{MetricComparison, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, Needs, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};

const DOC: &str = "How often it breaks a rule of the road: passes a red light, or a stop sign without standing, \
                   takes another vehicle's right of way, exceeds a speed limit, or overtakes a queue, at a zebra crossing, in a \
                   junction or before a light; the report lists each as `broken_rules`, with time and place";

pub(super) const METRICS: &[&dyn Metric] = &[&RulesBroken];

#[derive(Clone, Copy, Debug)]
struct RulesBroken;

impl Metric for RulesBroken {
    fn declaration(&self) -> MetricDeclaration {
        MetricDeclaration::of_vehicle("rules_broken", Count, DOC).compared(MetricComparison::Sum).with_others()
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(BrokenCount { vehicle, count: 0 })
    }

    fn needs(&self) -> Needs {
        Needs { broken_rules: true, ..Needs::STATES }
    }
}

#[derive(Clone, Copy, Debug)]
struct BrokenCount {
    vehicle: usize,
    count: u64,
}

impl Measurement for BrokenCount {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let name = &tick.frame.vehicles[self.vehicle].name;
        self.count += tick.frame.broken_rules.iter().filter(|broken| broken.vehicle == *name).count() as u64;
    }

    fn measured(&self) -> Measured {
        Measured { value: Some(MetricValue::Count(self.count)), ..Measured::default() }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}
