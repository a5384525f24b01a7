//! Time gap of a vehicle to its leader: the gap between bumpers along its route, over its speed.

use interplay_planners::{Body, Route, State};
use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{MetricComparison, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::Measured;
use crate::state::frame::Frame;

/// Maximum distance of a leader, for a real car \[m\].
const FOLLOWED_M: f64 = 90.0;
/// Below this speed a vehicle is queueing and not following, for a real car \[m/s\].
const SLOWEST_MPS: f64 = 2.0;
/// Time gaps below this are short, for a real car \[s\].
const SHORT_S: f64 = 0.5;

const DOC_SHORT: &str = "Share of the time behind a leader with a time gap below 0.5 s, of a real car; none for a vehicle that \
                         follows no leader";
const DOC_MEDIAN: &str = "Median of its time gaps to the vehicle ahead";

pub(super) const METRICS: &[&dyn Metric] = &[
    &TimeGap { declaration: MetricDeclaration::of_vehicle("short_gap_share", Number, DOC_SHORT), fold: short_share },
    &TimeGap {
        declaration: MetricDeclaration::of_vehicle("median_time_gap_s", Number, DOC_MEDIAN)
            .compared(MetricComparison::Quantiles),
        fold: median,
    },
];

/// A metric over all time gaps of a vehicle.
#[derive(Clone, Copy, Debug)]
struct TimeGap {
    declaration: MetricDeclaration,
    /// The value, from the ascending gaps as times of a real car \[s\], none of which is missing, and from the ratio of times.
    fold: fn(&[f64], f64) -> f64,
}

impl Metric for TimeGap {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(TimeGaps { fold: self.fold, vehicle, ratio: 1.0, gaps_s: Vec::new() })
    }
}

#[derive(Clone, Debug)]
struct TimeGaps {
    fold: fn(&[f64], f64) -> f64,
    vehicle: usize,
    /// Ratio of its times to those of a real car.
    ratio: f64,
    /// Time gaps, as times of a real car \[s\].
    gaps_s: Vec<f64>,
}

impl Measurement for TimeGaps {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let scale = tick.end.vehicles[self.vehicle].body.real_ratio();
        self.ratio = scale.sqrt();
        self.gaps_s.extend(time_gap_s(tick.frame, &tick.end, self.vehicle).map(|gap_s| gap_s / scale.sqrt()));
    }

    fn measured(&self) -> Measured {
        let mut sorted = self.gaps_s.clone();
        sorted.sort_by(f64::total_cmp);
        Measured::number((!sorted.is_empty()).then(|| (self.fold)(&sorted, self.ratio)))
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}

fn short_share(sorted_s: &[f64], _: f64) -> f64 {
    sorted_s.partition_point(|gap_s| *gap_s < SHORT_S) as f64 / sorted_s.len() as f64
}

fn median(sorted_s: &[f64], ratio: f64) -> f64 {
    ratio * sorted_s[sorted_s.len() / 2]
}

/// The gap to the nearest vehicle ahead in the same lane and direction, over the speed \[s\]; none without a leader, or at low speed.
pub(crate) fn time_gap_s(frame: &Frame, end: &ObservedMoment<'_>, vehicle: usize) -> Option<f64> {
    let (stated, states) = (&end.vehicles[vehicle], end.states);
    let (own, own_m, scale) = (&states[vehicle], end.along_m[vehicle], stated.body.real_ratio());
    if own.speed_mps < SLOWEST_MPS * scale.sqrt() {
        return None;
    }
    let own_across_m = stated.route.across(own.position());
    let others = end.vehicles.iter().zip(states).enumerate();
    let others = others.filter(|(index, _)| *index != vehicle && !frame.vehicles[*index].is_absent);
    // The distance along the road is never much shorter than the straight-line distance.
    let is_near = |body: &Body, state: &State| {
        let [x_m, y_m] = [state.x_m - own.x_m, state.y_m - own.y_m];
        let most_m = 1.5 * FOLLOWED_M * scale + stated.body.front_m + body.rear_m;
        x_m * x_m + y_m * y_m <= most_m * most_m
    };
    let others = others.filter(|(_, (other, state))| is_near(&other.body, state));
    let gaps = others.filter_map(|(_, (other, state))| {
        let (ahead_m, across_m) = ahead(&stated.route, own_m, state)?;
        let reach_m = 0.5 * (stated.body.width_m + other.body.width_m);
        let gap_m = ahead_m - stated.body.front_m - other.body.rear_m;
        ((across_m - own_across_m).abs() < reach_m && gap_m < FOLLOWED_M * scale).then_some(gap_m.max(0.0))
    });
    gaps.min_by(f64::total_cmp).map(|gap_m| gap_m / own.speed_mps)
}

/// Distance ahead along a route and lateral offset of a vehicle that drives in the route's direction \[m\].
fn ahead(route: &Route, own_m: f64, state: &State) -> Option<(f64, f64)> {
    let at = route.locate(state.position(), None);
    let is_along = libm::cos(state.heading_rad - at.heading_rad) > std::f64::consts::FRAC_1_SQRT_2;
    (is_along && at.along_m > own_m).then_some((at.along_m - own_m, at.across_m))
}
