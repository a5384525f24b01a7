//! Where a vehicle stands: its distance to the one ahead, and whether it blocks a junction.

use interplay_planners::road::network::ConflictKind;
use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{Better, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::Measured;
use crate::state::standing::{Standing, StandingReason};

/// Two vehicles are at rest behind each other after they have both stood this long, for a real car \[s\].
const AT_REST_S: f64 = 2.0;

const LEAST_DOC: &str = "Smallest distance to the vehicle ahead in its lane, between bumpers, after both have stood for 2 s, of a real car; \
                         none if it never stood behind a vehicle less than 30 m ahead";
const LARGEST_DOC: &str = "Largest such distance";
const BLOCKED_DOC: &str = "Time for which it stands where the route of another vehicle or pedestrian crosses its own, for another \
                           reason than to give way: because there was no room behind the crossing when it entered";

pub(super) const METRICS: &[&dyn Metric] = &[
    &RestMetric {
        declaration: MetricDeclaration::of_vehicle("min_gap_at_rest_m", Number, LEAST_DOC),
        value: |rest| rest.gaps_m.map(|[least_m, _]| least_m),
    },
    &RestMetric {
        declaration: MetricDeclaration::of_vehicle("max_gap_at_rest_m", Number, LARGEST_DOC),
        value: |rest| rest.gaps_m.map(|[_, largest_m]| largest_m),
    },
    &RestMetric {
        declaration: MetricDeclaration::of_vehicle("blocks_junction_s", Number, BLOCKED_DOC)
            .better(Better::Lower)
            .with_others(),
        value: |rest| Some(rest.blocked_s),
    },
];

#[derive(Clone, Copy, Debug)]
struct RestMetric {
    declaration: MetricDeclaration,
    value: fn(&Rest) -> Option<f64>,
}

impl Metric for RestMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn begin(&self, _: &Scenario, start: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        let own = &start.vehicles[vehicle];
        let others = start.vehicles.iter().enumerate().filter(|(other, _)| *other != vehicle);
        let crossed = others.flat_map(|(_, theirs)| own.route.conflicts_with(&theirs.route));
        let crossed = crossed.filter(|conflict| conflict.kind == ConflictKind::Crossing);
        let mut crossings_m: Vec<[f64; 2]> = Vec::new();
        for conflict in crossed {
            if !crossings_m.contains(&conflict.own_m) {
                crossings_m.push(conflict.own_m);
            }
        }
        Box::new(Rest { value: self.value, vehicle, crossings_m, behind: None, gaps_m: None, blocked_s: 0.0 })
    }
}

/// How one vehicle has stood so far.
#[derive(Clone, Debug)]
struct Rest {
    value: fn(&Rest) -> Option<f64>,
    vehicle: usize,
    /// Where other routes cross its own, from and to \[m\].
    crossings_m: Vec<[f64; 2]>,
    /// The vehicle behind which it stands, and for how long both have stood \[s\].
    behind: Option<(usize, f64)>,
    /// The smallest and the largest gap at rest \[m\].
    gaps_m: Option<[f64; 2]>,
    blocked_s: f64,
}

impl Measurement for Rest {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let standing = Standing::of(tick.end.vehicles, tick.frame);
        if !standing.stands(self.vehicle) {
            self.behind = None;
            return;
        }
        self.observe_gap(&standing, tick);
        let (body, along_m) = (&tick.end.vehicles[self.vehicle].body, tick.end.along_m[self.vehicle]);
        let is_in = |[from_m, to_m]: &[f64; 2]| along_m + body.front_m > *from_m && along_m - body.rear_m < *to_m;
        let gives_way = |reason: &StandingReason| {
            use StandingReason::{Behind, InWay, Passage};
            !matches!(reason, Behind(_) | InWay(_) | Passage(_))
        };
        if self.crossings_m.iter().any(is_in) && !standing.plain_reason(self.vehicle).as_ref().is_some_and(gives_way) {
            self.blocked_s += tick.step_s;
        }
    }

    fn measured(&self) -> Measured {
        Measured::number((self.value)(self))
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}

impl Rest {
    fn observe_gap(&mut self, standing: &Standing<'_>, tick: &ObservedTick<'_>) {
        let ahead = standing.stationary_ahead(self.vehicle);
        let Some((leader, gap_m)) = ahead else {
            self.behind = None;
            return;
        };
        let before_s = self.behind.filter(|(known, _)| *known == leader).map_or(0.0, |(_, stood_s)| stood_s);
        let stood_s = before_s + tick.step_s;
        self.behind = Some((leader, stood_s));
        if stood_s >= AT_REST_S * tick.end.vehicles[self.vehicle].body.real_ratio().sqrt() {
            let [least_m, largest_m] = self.gaps_m.unwrap_or([gap_m; 2]);
            self.gaps_m = Some([least_m.min(gap_m), largest_m.max(gap_m)]);
        }
    }
}
