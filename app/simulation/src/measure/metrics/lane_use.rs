//! The time for which a vehicle is astride a line between lanes, or on the side of the road that belongs to oncoming traffic.

use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{Better, MetricDeclaration, Scenario};

use crate::measure::lane_use::{LaneLines, LaneUse};
use crate::measure::metric::{Measurement, Metric, Needs, ObservedMoment, ObservedTick};
use crate::measure::values::Measured;
use crate::state::standing::Standing;

const ASTRIDE_DOC: &str = "Time for which a corner is at least 0.2 m, of a real car, across a line between two lanes, from the lane that \
                           its centre is on";
const LONGEST_ASTRIDE_DOC: &str = "The longest such time without a break";
const ONCOMING_DOC: &str = "Time for which a corner is at least 0.2 m, of a real car, on a lane of the opposite direction, or its centre is on one";
const LONGEST_ONCOMING_DOC: &str = "The longest such time without a break";
const PAST_QUEUE_DOC: &str = "Time on a lane of the opposite direction while a vehicle of its own lane, beside it or less than 15 m of a \
                              real car ahead, waits for a visible reason: a line, a light, a crossing, or another that waits";

pub(super) const METRICS: &[&dyn Metric] = &[
    &LaneUseMetric {
        declaration: MetricDeclaration::of_vehicle("astride_s", Number, ASTRIDE_DOC).better(Better::Lower),
        counts: |place, _| place.is_astride,
        is_longest: false,
    },
    &LaneUseMetric {
        declaration: MetricDeclaration::of_vehicle("longest_astride_s", Number, LONGEST_ASTRIDE_DOC),
        counts: |place, _| place.is_astride,
        is_longest: true,
    },
    &LaneUseMetric {
        declaration: MetricDeclaration::of_vehicle("oncoming_s", Number, ONCOMING_DOC).better(Better::Lower),
        counts: |place, _| place.is_oncoming,
        is_longest: false,
    },
    &LaneUseMetric {
        declaration: MetricDeclaration::of_vehicle("longest_oncoming_s", Number, LONGEST_ONCOMING_DOC),
        counts: |place, _| place.is_oncoming,
        is_longest: true,
    },
    &LaneUseMetric {
        declaration: MetricDeclaration::of_vehicle("oncoming_past_queue_s", Number, PAST_QUEUE_DOC)
            .better(Better::Lower)
            .with_others(),
        counts: |place, passes_queue| place.is_oncoming && passes_queue(),
        is_longest: false,
    },
];

#[derive(Clone, Copy, Debug)]
struct LaneUseMetric {
    declaration: MetricDeclaration,
    /// Whether a tick counts that ends at a place; the second argument tells whether the vehicle is beside or behind a queue.
    counts: fn(LaneUse, &dyn Fn() -> bool) -> bool,
    /// Whether the longest stretch of ticks that count is the value, and not their sum.
    is_longest: bool,
}

impl Metric for LaneUseMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn begin(&self, scenario: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        let lines = LaneLines::of(scenario, &scenario.vehicles[vehicle]);
        Box::new(TimeInPlace { metric: *self, vehicle, lines, now_s: 0.0, value_s: 0.0 })
    }

    fn needs(&self) -> Needs {
        Needs::STATES
    }
}

/// The time of one vehicle so far.
#[derive(Clone, Debug)]
struct TimeInPlace {
    metric: LaneUseMetric,
    vehicle: usize,
    lines: LaneLines,
    /// Length of the present stretch \[s\].
    now_s: f64,
    value_s: f64,
}

impl Measurement for TimeInPlace {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let moment = tick.end.of(self.vehicle);
        if moment.vehicle.obstacle.is_some() {
            return;
        }
        let place = self.lines.used_by(moment.vehicle, moment.state, moment.along_m);
        let passes_queue = || {
            let standing = Standing::of(tick.end.vehicles, tick.frame);
            standing.queue_beside(self.vehicle).is_some()
        };
        if !(self.metric.counts)(place, &passes_queue) {
            self.now_s = 0.0;
            return;
        }
        self.now_s += tick.step_s;
        self.value_s = if self.metric.is_longest { self.value_s.max(self.now_s) } else { self.value_s + tick.step_s };
    }

    fn measured(&self) -> Measured {
        Measured::number(Some(self.value_s))
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}
