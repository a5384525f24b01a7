//! Counts how often a vehicle brakes harder than drivers do without an emergency.

use interplay_scenarios::MetricKind::Count;
use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, Needs, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};

/// Emergency braking exceeds this; by Froude's law accelerations are the same at every scale \[m/s²\].
const EMERGENCY_MPS2: f64 = 4.0;
/// An emergency is over when the braking is below this \[m/s²\].
const OVER_MPS2: f64 = 3.0;
/// Rounding error of a deceleration computed from speeds \[m/s²\].
const ROUNDING_MPS2: f64 = 1e-6;

const DOC: &str = "How often it brakes with more than 4 m/s²; once until it brakes with less than 3 m/s² again";

pub(super) const METRICS: &[&dyn Metric] = &[&EmergencyBraking];

#[derive(Clone, Copy, Debug)]
struct EmergencyBraking;

impl Metric for EmergencyBraking {
    fn declaration(&self) -> MetricDeclaration {
        MetricDeclaration::of_vehicle("emergency_braking", Count, DOC)
            .compared(MetricComparison::Sum)
            .better(Better::Lower)
            .with_others()
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(Emergencies { vehicle, is_braking: false, count: 0 })
    }

    fn needs(&self) -> Needs {
        Needs::STATES
    }
}

/// The emergencies of one vehicle so far.
#[derive(Clone, Copy, Debug)]
struct Emergencies {
    vehicle: usize,
    is_braking: bool,
    count: u64,
}

impl Measurement for Emergencies {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let [before, after] = [&tick.frame.vehicles[self.vehicle].state, &tick.end.states[self.vehicle]];
        let braking_mps2 = (before.speed_mps - after.speed_mps) / tick.step_s;
        let is_hard = braking_mps2 > EMERGENCY_MPS2 + ROUNDING_MPS2;
        self.count += u64::from(is_hard && !self.is_braking);
        self.is_braking = is_hard || (self.is_braking && braking_mps2 >= OVER_MPS2);
    }

    fn measured(&self) -> Measured {
        Measured { value: Some(MetricValue::Count(self.count)), ..Measured::default() }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}

#[cfg(test)]
mod tests {
    use interplay_planners::{Input, State};

    use super::*;
    use crate::measure::metrics::tests::over_ticks;

    #[test]
    fn each_emergency_braking_is_counted_once() {
        let count = |brakings_mps2: &[f64]| {
            let mut speed_mps = 20.0;
            let ticks = brakings_mps2.iter().map(|braking_mps2| {
                let before = State { speed_mps, ..State::default() };
                speed_mps -= 0.1 * braking_mps2;
                (Input::default(), [before, State { speed_mps, ..State::default() }])
            });
            over_ticks(&EmergencyBraking, &ticks.collect::<Vec<_>>()).value
        };
        assert_eq!(count(&[0.0, 2.0, 4.0, 4.0, -1.0]), Some(MetricValue::Count(0)));
        assert_eq!(count(&[5.0, 3.5, 4.5, 2.0, 6.0]), Some(MetricValue::Count(2)));
    }
}
