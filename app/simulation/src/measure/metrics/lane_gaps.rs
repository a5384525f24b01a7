//! The gaps that a vehicle accepts when it changes lanes, and the braking of the vehicle behind that follows.
//!
//! A vehicle changes lanes when its centre crosses a lane line and then reaches at least 5 % of the lane's width beyond it. The leader
//! and the follower are the nearest vehicles in the new lane within 90 m of a real car that drive in the same direction. The lead gap is
//! the distance to the leader over the vehicle's own speed, the lag gap the follower's distance over the follower's speed, both at the
//! crossing and between bumpers along the vehicle's route. Of several lane changes in a run the worst one counts.

use interplay_planners::{Route, State};
use interplay_scenarios::MetricKind::{Flag, Number};
use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, Scenario, Vehicle};

use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::Measured;
use crate::state::standing::STANDING_MPS;

/// Maximum distance of a leader or follower, for a real car \[m\].
const NEAR_M: f64 = 90.0;
/// A lane change is complete when the centre is this far beyond the line, in lane widths.
const BEYOND_LANES: f64 = 0.05;
/// Time after a lane change during which braking of the follower is attributed to it, for a real car \[s\].
const ANSWERED_S: f64 = 4.0;
/// The follower brakes if its deceleration exceeds this \[m/s²\].
const FELT_MPS2: f64 = 1.0;

const DOC_LEAD: &str = "Shortest time gap to the vehicle ahead in the new lane when it changes its lane: the distance between bumpers \
                        over its own speed; none without a change, or without a vehicle ahead";
const DOC_LAG: &str = "Shortest time gap of the vehicle behind in the new lane when it changes its lane: the distance between bumpers \
                       over the speed of the one behind; none without a change, or without a moving vehicle behind";
const DOC_BRAKING: &str = "Hardest braking of the vehicle behind in the new lane within 4 s, of a real car, after it changed its lane; \
                           none without a change, or without a vehicle behind";
const DOC_BRAKES: &str = "Whether the vehicle behind brakes with more than 1 m/s² within 4 s, of a real car, after it changed its lane; \
                          none without a change, or without a vehicle behind";

pub(super) const METRICS: &[&dyn Metric] = &[
    &LaneChangeMetric {
        declaration: MetricDeclaration::of_vehicle("accepted_lead_gap_s", Number, DOC_LEAD)
            .compared(MetricComparison::Quantiles)
            .better(Better::Higher),
        fold: |changes| least(changes, |change| change.lead_s),
    },
    &LaneChangeMetric {
        declaration: MetricDeclaration::of_vehicle("accepted_lag_gap_s", Number, DOC_LAG)
            .compared(MetricComparison::Quantiles)
            .better(Better::Higher),
        fold: |changes| least(changes, |change| change.lag_s),
    },
    &LaneChangeMetric {
        declaration: MetricDeclaration::of_vehicle("follower_braking_mps2", Number, DOC_BRAKING)
            .compared(MetricComparison::Mean)
            .better(Better::Lower),
        fold: hardest_braking,
    },
    &LaneChangeMetric {
        declaration: MetricDeclaration::of_vehicle("follower_brakes", Flag, DOC_BRAKES)
            .compared(MetricComparison::Share)
            .better(Better::Lower),
        fold: |changes| hardest_braking(changes).map(|braking_mps2| f64::from(braking_mps2 > FELT_MPS2)),
    },
];

#[derive(Clone, Copy, Debug)]
struct LaneChangeMetric {
    declaration: MetricDeclaration,
    /// The value, from the lane changes in order; none if there is none.
    fold: fn(&[LaneChange]) -> Option<f64>,
}

#[derive(Clone, Copy, Debug)]
struct LaneChange {
    /// Time at which the centre crossed the line \[s\].
    at_s: f64,
    /// The new lane.
    to: i64,
    /// Time gap to the leader \[s\].
    lead_s: Option<f64>,
    /// Time gap of the follower \[s\].
    lag_s: Option<f64>,
    follower: Option<usize>,
    /// Its hardest braking so far \[m/s²\].
    braking_mps2: f64,
}

fn least(changes: &[LaneChange], number: fn(&LaneChange) -> Option<f64>) -> Option<f64> {
    changes.iter().filter_map(number).min_by(f64::total_cmp)
}

fn hardest_braking(changes: &[LaneChange]) -> Option<f64> {
    let answered = changes.iter().filter(|change| change.follower.is_some());
    answered.map(|change| change.braking_mps2).max_by(f64::total_cmp)
}

impl Metric for LaneChangeMetric {
    fn declaration(&self) -> MetricDeclaration {
        self.declaration
    }

    fn begin(&self, scenario: &Scenario, start: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        let lanes = Lanes::of(scenario, &scenario.vehicles[vehicle]);
        let lane = start.states.get(vehicle).map_or(0, |state| lanes.at(&start.vehicles[vehicle].route, state).lane);
        Box::new(LaneChanges { fold: self.fold, vehicle, lanes, lane, begun: None, changes: Vec::new() })
    }
}

/// The lanes of a route, all as wide as its own unless stated otherwise.
#[derive(Clone, Copy, Debug)]
struct Lanes {
    /// Lateral coordinate of the centre of lane 0 \[m\].
    first_m: f64,
    /// Width of the parallel lanes of a road; none on a network, where the lane of the route has a width \[m\].
    width_m: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
struct PlaceInLanes {
    along_m: f64,
    /// The lane, counted from the right.
    lane: i64,
    /// Distance of the centre from the nearer line of its lane, in lane widths.
    inside: f64,
    /// Lateral coordinate of the centre of the lane \[m\].
    centre_m: f64,
    heading_rad: f64,
}

impl Lanes {
    fn of(scenario: &Scenario, vehicle: &Vehicle) -> Lanes {
        let first_m = scenario.road.lane_centre_m(vehicle.road, 0).filter(|_| scenario.network.is_none());
        Lanes { first_m: first_m.unwrap_or(0.0), width_m: first_m.map(|_| scenario.road.lane_width_m()) }
    }

    fn at(&self, route: &Route, state: &State) -> PlaceInLanes {
        let at = route.locate(state.position(), None);
        let width_m = self.width_m.unwrap_or_else(|| 2.0 * route.half_width.value(at.along_m));
        let lanes = (at.across_m - self.first_m) / width_m;
        let lane = lanes.round();
        PlaceInLanes {
            along_m: at.along_m,
            lane: lane as i64,
            inside: 0.5 - (lanes - lane).abs(),
            centre_m: self.first_m + lane * width_m,
            heading_rad: at.heading_rad,
        }
    }
}

/// The lane changes of one vehicle so far.
#[derive(Clone, Debug)]
struct LaneChanges {
    fold: fn(&[LaneChange]) -> Option<f64>,
    vehicle: usize,
    lanes: Lanes,
    lane: i64,
    /// A lane change whose line was crossed, but which is not complete.
    begun: Option<LaneChange>,
    changes: Vec<LaneChange>,
}

impl Measurement for LaneChanges {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let ObservedMoment { time_s, vehicles, states, .. } = tick.end;
        let own = &vehicles[self.vehicle];
        let answered_s = ANSWERED_S * own.body.real_ratio().sqrt();
        for change in self.begun.iter_mut().chain(&mut self.changes) {
            let follower = change.follower.filter(|_| time_s <= change.at_s + answered_s);
            let braking = follower.map(|index| braking_mps2(tick, index));
            change.braking_mps2 = braking.unwrap_or(0.0).max(change.braking_mps2);
        }
        let place = self.lanes.at(&own.route, &states[self.vehicle]);
        if place.lane == self.lane {
            self.begun = None;
            return;
        }
        let edges_m = own.route.right.value(place.along_m)..=own.route.left.value(place.along_m);
        if !edges_m.contains(&place.centre_m) {
            return;
        }
        if self.begun.is_none_or(|begun| begun.to != place.lane) {
            self.begun = Some(self.change(tick, &place));
        }
        if place.inside > BEYOND_LANES {
            self.lane = place.lane;
            self.changes.extend(self.begun.take());
        }
    }

    fn measured(&self) -> Measured {
        Measured::number((self.fold)(&self.changes))
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}

impl LaneChanges {
    /// A lane change that begins now, with leader and follower in the new lane.
    fn change(&self, tick: &ObservedTick<'_>, place: &PlaceInLanes) -> LaneChange {
        let moment = &tick.end;
        let (own, own_mps) = (&moment.vehicles[self.vehicle], moment.states[self.vehicle].speed_mps);
        let scale = own.body.real_ratio();
        let is_there = |other: &usize| *other != self.vehicle && !tick.frame.vehicles[*other].is_absent;
        let others = (0..moment.vehicles.len()).filter(is_there);
        let in_lane = others.filter_map(|other| {
            let (body, state) = (&moment.vehicles[other].body, &moment.states[other]);
            let there = self.lanes.at(&own.route, state);
            let is_along = libm::cos(state.heading_rad - there.heading_rad) > std::f64::consts::FRAC_1_SQRT_2;
            let ahead_m = there.along_m - place.along_m;
            let lengths_m = if ahead_m > 0.0 { own.body.front_m + body.rear_m } else { own.body.rear_m + body.front_m };
            let gap_m = (ahead_m.abs() - lengths_m).max(0.0);
            let is_near = is_along && there.lane == place.lane && gap_m < NEAR_M * scale;
            is_near.then_some((other, ahead_m, gap_m))
        });
        let nearest = |is_ahead: bool| {
            let there = in_lane.clone().filter(|(_, ahead_m, _)| (*ahead_m > 0.0) == is_ahead);
            there.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        };
        let time_s = |gap_m: f64, speed_mps: f64| (speed_mps > STANDING_MPS * scale.sqrt()).then(|| gap_m / speed_mps);
        let (lead, lag) = (nearest(true), nearest(false));
        LaneChange {
            at_s: moment.time_s,
            to: place.lane,
            lead_s: lead.and_then(|(_, _, gap_m)| time_s(gap_m, own_mps)),
            lag_s: lag.and_then(|(other, _, gap_m)| time_s(gap_m, moment.states[other].speed_mps)),
            follower: lag.map(|(other, ..)| other),
            braking_mps2: 0.0,
        }
    }
}

/// The deceleration of a vehicle in a tick, from its speeds \[m/s²\].
fn braking_mps2(tick: &ObservedTick<'_>, vehicle: usize) -> f64 {
    (tick.frame.vehicles[vehicle].state.speed_mps - tick.end.states[vehicle].speed_mps) / tick.step_s
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::metric::SharedStates;
    use crate::state::frame::{Frame, VehicleFrame};
    use interplay_scenarios::load;

    /// Measures the ego, one tick each second, with states before and after the tick of ego, leader and follower in the new lane.
    fn measured(metric: &dyn Metric, moments: &[[State; 3]]) -> Option<f64> {
        let mut scenario = load("full-size/lane-change", &[]).expect("authored");
        let mut template = scenario.vehicles[0].clone();
        template.body.scale = interplay_planners::Body::REAL_SCALE;
        scenario.vehicles = vec![template; 3];
        let vehicles = &scenario.vehicles[..];
        let along_m = [0.0; 3];
        let moment = |states, time_s| ObservedMoment { time_s, vehicles, states, along_m: &along_m };
        let mut measurement = metric.begin(&scenario, &moment(&moments[0], 0.0), 0);
        for (tick, pair) in moments.windows(2).enumerate() {
            let before = pair[0].map(|state| VehicleFrame { state, ..VehicleFrame::default() });
            let frame = Frame { vehicles: before.to_vec(), ..Frame::default() };
            let end = moment(&pair[1], tick as f64 + 1.0);
            measurement.observe(&ObservedTick {
                frame: &frame,
                step_s: 1.0,
                shared: &SharedStates::default(),
                previous_inputs: &[],
                end,
            });
        }
        measurement.measured().value.map(crate::measure::values::MetricValue::as_number)
    }

    /// Crosses the line after a second and is completely in the new lane after two; the follower brakes by 2 m/s² in the third second, and
    /// by 5 after the fourth.
    fn cut_in() -> Vec<[State; 3]> {
        let scenario = load("full-size/lane-change", &[]).expect("authored");
        let (vehicle, width_m) = (&scenario.vehicles[0], scenario.road.lane_width_m());
        let first_m = scenario.road.lane_centre_m(vehicle.road, 0).expect("parallel lanes");
        let at = |along_m: f64, lanes: f64, speed_mps: f64| {
            let [x_m, y_m] = vehicle.route.position(along_m, first_m + lanes * width_m);
            State { x_m, y_m, heading_rad: 0.0, speed_mps }
        };
        let own = [0.0, 0.52, 1.0, 1.0, 1.0, 1.0, 1.0];
        let follower_mps = [20.0, 20.0, 20.0, 18.0, 18.0, 18.0, 13.0];
        own.into_iter()
            .zip(follower_mps)
            .map(|(lanes, mps)| [at(50.0, lanes, 10.0), at(74.5, 1.0, 12.0), at(15.5, 1.0, mps)])
            .collect()
    }

    #[test]
    fn lane_change_gaps_are_measured_at_the_crossing_and_braking_after_it() {
        let body = load("full-size/lane-change", &[]).expect("authored").vehicles[0].body;
        let moments = cut_in();
        let length_m = body.front_m + body.rear_m;
        let close =
            |got: Option<f64>, want: f64| assert!(got.is_some_and(|got| (got - want).abs() < 1e-9), "{got:?}, {want}");
        close(measured(METRICS[0], &moments), (24.5 - length_m) / 10.0);
        close(measured(METRICS[1], &moments), (34.5 - length_m) / 20.0);
        close(measured(METRICS[2], &moments), 2.0);
        close(measured(METRICS[3], &moments), 1.0);
    }

    /// A vehicle that touches the line and returns has not changed lanes, and neither has one that stays.
    #[test]
    fn a_vehicle_that_returns_has_not_changed_lanes() {
        let moments = cut_in();
        let back = [moments[0], moments[1], moments[0], moments[0]];
        let stays = [moments[2], moments[3]];
        for metric in METRICS {
            assert_eq!(measured(*metric, &back), None);
            assert_eq!(measured(*metric, &stays), None);
        }
    }
}
