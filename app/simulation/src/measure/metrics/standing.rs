//! The time for which a vehicle that wants to move is stationary without a visible reason ([`Standing`]).

use interplay_scenarios::MetricKind::{Count, Number};
use interplay_scenarios::{MetricComparison, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};
use crate::measure::waits::STUCK_S;
use crate::state::standing::Standing;

const DOC_LONGEST: &str =
    "Longest time for which it stands although it wants to drive, without a visible reason to wait";
const DOC_DEADLOCKS: &str = "How often it stands so for more than 10 s, of a real car";

pub(super) const METRICS: &[&dyn Metric] = &[
    &StandingMetric {
        declaration: MetricDeclaration::of_vehicle("unexplained_standing_s", Number, DOC_LONGEST),
        value: |standing| MetricValue::Number(standing.longest_s),
    },
    &StandingMetric {
        // Comparisons reserve "deadlocks" for runs in which the ego never completed its task.
        declaration: MetricDeclaration {
            comparison_key: Some("stuck"),
            ..MetricDeclaration::of_vehicle("deadlocks", Count, DOC_DEADLOCKS)
                .compared(MetricComparison::Sum)
                .with_others()
        },
        value: |standing| MetricValue::Count(standing.deadlocks),
    },
];

#[derive(Clone, Copy, Debug)]
struct StandingMetric {
    declaration: MetricDeclaration,
    value: fn(&StandingSoFar) -> MetricValue,
}

impl Metric for StandingMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn begin(&self, scenario: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        let scale = scenario.vehicles[vehicle].body.real_ratio();
        let (value, stuck_s) = (self.value, STUCK_S * scale.sqrt());
        let has_crashed = false;
        Box::new(StandingSoFar { value, vehicle, stuck_s, has_crashed, now_s: 0.0, longest_s: 0.0, deadlocks: 0 })
    }
}

/// The standing time of one vehicle.
#[derive(Clone, Copy, Debug)]
struct StandingSoFar {
    value: fn(&StandingSoFar) -> MetricValue,
    vehicle: usize,
    stuck_s: f64,
    /// Whether it has had a contact, which then is the reason.
    has_crashed: bool,
    now_s: f64,
    longest_s: f64,
    deadlocks: u64,
}

impl Measurement for StandingSoFar {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let standing = Standing::of(tick.end.vehicles, tick.frame);
        let name = &tick.end.vehicles[self.vehicle].name;
        self.has_crashed |= tick.frame.collisions.iter().any(|collision| collision.between.contains(name));
        let is_told = standing.told_by(self.vehicle).is_some();
        if is_told || self.has_crashed || !standing.stands(self.vehicle) || standing.reason(self.vehicle).is_some() {
            self.now_s = 0.0;
            return;
        }
        let before_s = self.now_s;
        self.now_s += tick.step_s;
        self.longest_s = self.longest_s.max(self.now_s);
        self.deadlocks += u64::from(before_s <= self.stuck_s && self.now_s > self.stuck_s);
    }

    fn measured(&self) -> Measured {
        Measured { value: Some((self.value)(self)), ..Measured::default() }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}
