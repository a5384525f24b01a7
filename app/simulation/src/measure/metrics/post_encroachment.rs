//! The post-encroachment time of two vehicles whose paths cross.
//!
//! The post-encroachment time of a vehicle with another one is the shortest time from when the footprint of one leaves
//! a point until the footprint of the other covers it (Allen, Shin and Cooper, 1978). It is computed from the driven footprints, between
//! ticks by interpolation in steps of at most 0.05 s of a real car. Vehicles that follow each other have time gaps instead.

use std::collections::VecDeque;

use interplay_planners::{Body, State};
use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, Scenario};

use crate::measure::metric::{Measurement, Metric, MomentStates, ObservedMoment, ObservedTick};
use crate::measure::rectangle::{half_diagonal_m, overlap};
use crate::measure::values::Measured;

/// Longer times do not count as encounters, for a real car \[s\].
const LONGEST_S: f64 = 5.0;
/// Longest step between two footprints that are compared, for a real car \[s\].
const STEP_S: f64 = 0.05;

const DOC: &str = "Shortest time between its leaving a place and another vehicle's coming there on a crossing path, or the other way \
                   round; none above 5 s, of a real car";

pub(super) const METRICS: &[&dyn Metric] = &[&PostEncroachment];

#[derive(Clone, Copy, Debug)]
struct PostEncroachment;

impl Metric for PostEncroachment {
    fn declaration(&self) -> MetricDeclaration {
        MetricDeclaration::of_vehicle("post_encroachment_s", Number, DOC)
            .compared(MetricComparison::Quantiles)
            .better(Better::Higher)
    }

    fn begin(&self, _: &Scenario, start: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        let reach_m = start.vehicles.iter().map(|vehicle| half_diagonal_m(&vehicle.body)).collect();
        let headings_rad = vec![[f64::INFINITY, f64::NEG_INFINITY]; start.vehicles.len()];
        Box::new(Encounters { vehicle, reach_m, headings_rad, past: VecDeque::new(), least_s: None })
    }
}

/// The states of all vehicles at a time \[s\].
#[derive(Clone, Debug)]
struct PastMoment {
    time_s: f64,
    states: MomentStates,
}

/// The encounters of one vehicle so far.
#[derive(Clone, Debug)]
struct Encounters {
    vehicle: usize,
    /// Largest distance of a body's points from its mass centre, in the scenario's order \[m\].
    reach_m: Vec<f64>,
    /// Range of headings in which each vehicle has driven so far \[rad\].
    headings_rad: Vec<[f64; 2]>,
    /// The past states that may still matter, oldest first.
    past: VecDeque<PastMoment>,
    least_s: Option<f64>,
}

impl Measurement for Encounters {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let bodies: Vec<&Body> = tick.end.vehicles.iter().map(|vehicle| &vehicle.body).collect();
        if bodies.len() < 2 {
            return;
        }
        let times = bodies[self.vehicle].real_ratio().sqrt();
        let steps = (tick.step_s / (STEP_S * times)).ceil().max(1.0) as usize;
        for (step, states) in (1..=steps).zip(tick.states_within(steps).iter().cloned()) {
            let share = step as f64 / steps as f64;
            let time_s = tick.end.time_s - (1.0 - share) * tick.step_s;
            for ([low, high], state) in self.headings_rad.iter_mut().zip(&*states) {
                let heading_rad = state.as_ref().map(|state| state.heading_rad);
                (*low, *high) = heading_rad.map_or((*low, *high), |rad| (low.min(rad), high.max(rad)));
            }
            while self.past.front().is_some_and(|moment| time_s - moment.time_s > LONGEST_S * times) {
                self.past.pop_front();
            }
            self.past.push_back(PastMoment { time_s, states });
            self.compare_last(&bodies);
        }
    }

    fn measured(&self) -> Measured {
        Measured::number(self.least_s)
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}

impl Encounters {
    /// Whether another vehicle has ever driven in a direction different from this one's.
    fn may_cross(&self, other: usize) -> bool {
        let [own, theirs] = [self.vehicle, other].map(|vehicle| self.headings_rad[vehicle]);
        other != self.vehicle && (own[1] - theirs[0]).max(theirs[1] - own[0]) >= ALONG_RAD
    }

    /// Compares the last footprints with earlier ones, the latest first.
    fn compare_last(&mut self, bodies: &[&Body]) {
        let Some(now) = self.past.back() else { return };
        let others: Vec<usize> = (0..bodies.len()).filter(|other| self.may_cross(*other)).collect();
        if others.is_empty() {
            return;
        }
        for past in self.past.iter().rev() {
            let apart_s = now.time_s - past.time_s;
            if self.least_s.is_some_and(|least_s| apart_s >= least_s) {
                return;
            }
            let meets = |first: usize, second: usize| {
                let (Some(then), Some(there)) = (&past.states[first], &now.states[second]) else { return false };
                let reach_m = self.reach_m[first] + self.reach_m[second];
                is_near(then, there, reach_m)
                    && !is_along(then, there)
                    && overlap(bodies[first], then, bodies[second], there)
            };
            if others.iter().any(|other| meets(self.vehicle, *other) || meets(*other, self.vehicle)) {
                self.least_s = Some(apart_s);
                return;
            }
        }
    }
}

/// Headings that differ by less are the same direction, below any rounding of [`is_along`] \[rad\].
const ALONG_RAD: f64 = 0.785;

/// Whether two vehicles drive in the same direction.
fn is_along(one: &State, other: &State) -> bool {
    libm::cos(one.heading_rad - other.heading_rad) > std::f64::consts::FRAC_1_SQRT_2
}

/// Whether two vehicles are close enough to overlap \[m\].
fn is_near(one: &State, other: &State, reach_m: f64) -> bool {
    let [x_m, y_m] = [one.x_m - other.x_m, one.y_m - other.y_m];
    x_m * x_m + y_m * y_m <= reach_m * reach_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::metric::SharedStates;
    use crate::state::frame::Frame;
    use crate::state::frame::VehicleFrame;
    use interplay_scenarios::load;

    /// The ego drives along x through the origin, which its centre reaches at `ego_s`, and the other along a heading, at 10 m/s.
    fn measured(ego_s: f64, other_s: f64, other_rad: f64) -> Option<f64> {
        let mut scenario = load("full-size/lane-change", &[]).expect("authored");
        let mut template = scenario.vehicles[0].clone();
        template.body.scale = Body::REAL_SCALE;
        scenario.vehicles = vec![template; 2];
        let at = |time_s: f64, there_s: f64, heading_rad: f64| {
            let (sin, cos) = libm::sincos(heading_rad);
            let along_m = 10.0 * (time_s - there_s);
            State { x_m: along_m * cos, y_m: along_m * sin, heading_rad, speed_mps: 10.0 }
        };
        let states = |time_s: f64| [at(time_s, ego_s, 0.0), at(time_s, other_s, other_rad)];
        let moments: Vec<[State; 2]> = (0..=100).map(|tick| states(f64::from(tick) * 0.1)).collect();
        let moment =
            |states, time_s| ObservedMoment { time_s, vehicles: &scenario.vehicles, states, along_m: &[0.0; 2] };
        let mut measurement = PostEncroachment.begin(&scenario, &moment(&moments[0], 0.0), 0);
        for (tick, pair) in moments.windows(2).enumerate() {
            let before_s = 0.1 * tick as f64;
            let vehicles = pair[0].map(|state| VehicleFrame { state, ..VehicleFrame::default() }).to_vec();
            let frame = Frame { time_s: before_s, vehicles, ..Frame::default() };
            let end = moment(&pair[1], before_s + 0.1);
            measurement.observe(&ObservedTick {
                frame: &frame,
                step_s: 0.1,
                shared: &SharedStates::default(),
                previous_inputs: &[],
                end,
            });
        }
        measurement.measured().value.map(crate::measure::values::MetricValue::as_number)
    }

    /// The first vehicle leaves the square where both paths cross with its rear; the second enters it with its front.
    #[test]
    fn post_encroachment_is_the_time_from_leaving_to_entering() {
        let body = load("full-size/lane-change", &[]).expect("authored").vehicles[0].body;
        let across = std::f64::consts::FRAC_PI_2;
        for (ego_s, other_s) in [(3.0, 5.0), (5.0, 3.0)] {
            let want = 2.0 - (body.front_m + body.rear_m + body.width_m) / 10.0;
            let got = measured(ego_s, other_s, across).expect("they cross");
            assert!(got >= want - 1e-9 && got <= want + 0.1 + 1e-9, "{got}, {want}");
        }
        assert_eq!(measured(3.0, 3.0, across), Some(0.0), "they touch");
        assert_eq!(measured(1.0, 8.0, across), None, "long after");
        assert_eq!(measured(3.0, 5.0, 0.1), None, "one follows the other");
    }
}
