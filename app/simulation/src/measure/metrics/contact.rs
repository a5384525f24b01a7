//! Fault in the first contact of the ego.
//!
//! On the lanes of a network, the right of way decides. The rules apply in this order:
//!
//! - a vehicle that has stood for a second of a real car is not at fault;
//! - in a conflict of the two routes, the vehicle that must yield is at fault; where the first to arrive goes first, the later one;
//! - of two vehicles that meet head-on, the one outside its lane is at fault, if the other is in its own;
//! - otherwise, and on roads without rules, the vehicle that approaches the other at least as fast as the other approaches it.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use interplay_planners::road::network::{Precedence, RouteConflict};
use interplay_planners::{Body, Route, State};
use interplay_scenarios::MetricDeclaration;
use interplay_scenarios::MetricKind::Flag;
use interplay_scenarios::{Scenario, Vehicle};

use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};
use crate::state::standing::STANDING_MPS;

/// A vehicle that has stood for this time is not at fault, for a real car \[s\].
const STOOD_S: f64 = 1.0;
/// A body is out of its lane if it is beyond the line by this share of its width.
const OUT_WIDTHS: f64 = 0.1;

const DOC: &str = "Whether the ego is at fault in its first contact: it took the right of way of the other, came out of its lane \
                   towards it, or ran into it while it stood; where no rule says so, it moved towards the other at least as fast as \
                   the other towards it";

pub(super) const METRICS: &[&dyn Metric] = &[&ContactByEgo];

#[derive(Clone, Copy, Debug)]
struct ContactByEgo;

impl Metric for ContactByEgo {
    fn declaration(&self) -> MetricDeclaration {
        MetricDeclaration::of_run("contact_by_ego", Flag, DOC)
    }

    fn begin(&self, scenario: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(FirstContact::of(vehicle, &scenario.vehicles))
    }
}

/// The first contact of the ego, and the state that its rules need.
#[derive(Clone, Debug)]
struct FirstContact {
    ego: usize,
    /// Whether the ego caused it; none before there is one.
    by_ego: Option<bool>,
    users: Vec<RoadUser>,
    /// Conflicts of the ego's route with other routes.
    encounters: Vec<Encounter>,
}

/// A vehicle, with the time for which it has stood \[s\].
#[derive(Clone, Debug)]
struct RoadUser {
    body: Body,
    route: Arc<Route>,
    stood_s: f64,
}

/// A conflict of the ego's route with that of another vehicle, and the times at which both fronts passed their lines \[s\].
#[derive(Clone, Debug)]
struct Encounter {
    other: usize,
    conflict: RouteConflict,
    arrived_s: [Option<f64>; 2],
}

impl FirstContact {
    fn of(ego: usize, vehicles: &[Vehicle]) -> Self {
        let user = |vehicle: &Vehicle| RoadUser { body: vehicle.body, route: Arc::clone(&vehicle.route), stood_s: 0.0 };
        let others = vehicles.iter().enumerate().filter(|(other, _)| *other != ego);
        let meets = |(other, theirs): (usize, &Vehicle)| {
            let conflicts = vehicles.get(ego).into_iter().flat_map(|own| own.route.conflicts_with(&theirs.route));
            let encounter =
                |conflict: &RouteConflict| Encounter { other, conflict: conflict.clone(), arrived_s: [None; 2] };
            conflicts.map(encounter).collect::<Vec<_>>()
        };
        FirstContact {
            ego,
            by_ego: None,
            encounters: others.flat_map(meets).collect(),
            users: vehicles.iter().map(user).collect(),
        }
    }

    /// Updates standing and arrival times at the beginning of a tick.
    fn remember(&mut self, tick: &ObservedTick<'_>) {
        let vehicles = &tick.frame.vehicles;
        for (user, vehicle) in self.users.iter_mut().zip(vehicles) {
            let stands = vehicle.state.speed_mps < STANDING_MPS * user.body.real_ratio().sqrt();
            user.stood_s = if stands { user.stood_s + tick.step_s } else { 0.0 };
        }
        let users = &self.users;
        let front_m = |vehicle: usize| users[vehicle].reach_m(&vehicles[vehicle].state)[1];
        for encounter in self.encounters.iter_mut().filter(|encounter| encounter.other < vehicles.len()) {
            let lines_m = [encounter.conflict.own_line_m, encounter.conflict.their_line_m];
            for ((arrived_s, vehicle), line_m) in
                encounter.arrived_s.iter_mut().zip([self.ego, encounter.other]).zip(lines_m)
            {
                let has_arrived = arrived_s.is_none() && front_m(vehicle) > line_m;
                *arrived_s = if has_arrived { Some(tick.frame.time_s) } else { *arrived_s };
            }
        }
    }

    /// Whether the ego is at fault in a contact with another vehicle; none if no rule decides.
    fn by_rule(&self, other: usize, states: [&State; 2]) -> Option<bool> {
        let [own, theirs] = [self.users.get(self.ego)?, self.users.get(other)?];
        if !(own.route.is_in_network() && theirs.route.is_in_network()) {
            return None;
        }
        match [own, theirs].map(RoadUser::has_stood) {
            [true, false] => return Some(false),
            [false, true] => return Some(true),
            [true, true] | [false, false] => {}
        }
        self.by_precedence(other, states).or_else(|| by_lane([own, theirs], states))
    }

    /// Whether the ego had to yield, in a conflict that both vehicles have entered.
    fn by_precedence(&self, other: usize, states: [&State; 2]) -> Option<bool> {
        let [own, theirs] = [&self.users[self.ego], &self.users[other]];
        let near_m = own.body.front_m + own.body.rear_m;
        let is_in = |user: &RoadUser, state: &State, [from_m, to_m]: [f64; 2]| {
            let [rear_m, front_m] = user.reach_m(state);
            front_m > from_m - near_m && rear_m < to_m
        };
        let here = self.encounters.iter().filter(|encounter| encounter.other == other).find(|encounter| {
            is_in(own, states[0], encounter.conflict.own_m) && is_in(theirs, states[1], encounter.conflict.their_m)
        })?;
        match (here.conflict.precedence, here.arrived_s) {
            (Precedence::Own, _) => Some(false),
            (Precedence::Other, _) => Some(true),
            (Precedence::ByArrival, [Some(own_s), Some(their_s)]) if own_s != their_s => Some(own_s > their_s),
            (Precedence::ByArrival, [Some(_), None]) => Some(false),
            (Precedence::ByArrival, [None, Some(_)]) => Some(true),
            (Precedence::ByArrival, _) => None,
        }
    }
}

impl RoadUser {
    fn has_stood(&self) -> bool {
        self.stood_s >= STOOD_S * self.body.real_ratio().sqrt()
    }

    /// Arc lengths of rear and front on its route \[m\].
    fn reach_m(&self, state: &State) -> [f64; 2] {
        let along_m = self.route.along(state.position());
        [along_m - self.body.rear_m, along_m + self.body.front_m]
    }

    fn is_out_of_lane(&self, state: &State) -> bool {
        let at = self.route.locate(state.position(), None);
        let beyond_m = at.across_m.abs() + 0.5 * self.body.width_m - self.route.half_width.value(at.along_m);
        beyond_m > OUT_WIDTHS * self.body.width_m
    }
}

/// Of two vehicles that meet head-on, whether the first is outside its lane and the second inside its own, or the reverse.
fn by_lane([own, theirs]: [&RoadUser; 2], states: [&State; 2]) -> Option<bool> {
    let is_head_on = libm::cos(states[0].heading_rad - states[1].heading_rad) < -FRAC_1_SQRT_2;
    match [own.is_out_of_lane(states[0]), theirs.is_out_of_lane(states[1])] {
        [own_is_out, they_are_out] if is_head_on && own_is_out != they_are_out => Some(own_is_out),
        _ => None,
    }
}

impl Measurement for FirstContact {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let vehicles = &tick.frame.vehicles;
        let Some(ego) = vehicles.get(self.ego).filter(|_| self.by_ego.is_none()) else { return };
        self.remember(tick);
        let contact = tick.frame.collisions.iter().find(|contact| contact.between.contains(&ego.name));
        let is_other =
            |name: &String| *name != ego.name && contact.is_some_and(|contact| contact.between.contains(name));
        if let Some(other) = vehicles.iter().position(|vehicle| is_other(&vehicle.name)) {
            let states = [&ego.state, &vehicles[other].state];
            self.by_ego = self.by_rule(other, states).or_else(|| Some(states[0].drives_into(states[1])));
        }
    }

    fn measured(&self) -> Measured {
        Measured { value: Some(MetricValue::Flag(self.by_ego.unwrap_or(false))), ..Measured::default() }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::metric::SharedStates;
    use crate::state::frame::{Collision, Frame, VehicleFrame};

    /// A vehicle that drives along the road.
    fn at(name: &str, x_m: f64, speed_mps: f64) -> VehicleFrame {
        let mut vehicle = VehicleFrame { name: name.to_owned(), ..VehicleFrame::default() };
        vehicle.state.x_m = x_m;
        vehicle.state.speed_mps = speed_mps;
        vehicle
    }

    #[test]
    fn the_vehicle_that_closes_in_is_at_fault_in_the_first_contact() {
        // The ego between two others, at the given speed; one of the others touches it.
        let frame = |ego_mps: f64, between: [&str; 2]| Frame {
            vehicles: vec![at("behind", -1.0, 1.0), at("ego", 0.0, ego_mps), at("ahead", 1.0, 0.5)],
            collisions: vec![Collision { time_s: 0.0, between: between.map(str::to_owned), impulse_ns: 1.0 }],
            ..Frame::default()
        };
        let by = |ego: usize, frames: &[Frame]| {
            let mut contact = FirstContact::of(ego, &[]);
            let end = ObservedMoment { time_s: 0.0, vehicles: &[], states: &[], along_m: &[] };
            for frame in frames {
                contact.observe(&ObservedTick {
                    frame,
                    step_s: 0.1,
                    shared: &SharedStates::default(),
                    previous_inputs: &[],
                    end,
                });
            }
            contact.measured().value == Some(MetricValue::Flag(true))
        };
        let [into, into_it] = [frame(1.0, ["ego", "ahead"]), frame(0.5, ["behind", "ego"])];
        assert!(by(1, std::slice::from_ref(&into)), "into the one ahead");
        assert!(!by(1, std::slice::from_ref(&into_it)), "the one behind into it");
        assert!(!by(1, &[frame(1.0, ["behind", "ahead"])]), "others");
        let quiet = Frame { collisions: Vec::new(), ..into.clone() };
        assert!(by(1, &[quiet, into.clone(), into_it.clone()]), "the first one counts");
        assert!(!by(1, &[into_it, into.clone()]), "the first one counts");
        assert!(!by(7, &[into]), "the vehicle does not exist");
    }

    /// A contact on a network: the ego and another one drive for 2 s to their places and speeds, and touch there.
    fn by_ego(name: &str, places: [(&str, f64, f64, f64); 2]) -> bool {
        let scenario = interplay_scenarios::load(name, &[]).expect("authored");
        let vehicles = places.map(|(vehicle, ..)| scenario.vehicle(vehicle).expect("authored").clone());
        let at = |index: usize, back_s: f64| {
            let (name, along_m, across_m, speed_mps) = places[index];
            let route = &vehicles[index].route;
            let [x_m, y_m] = route.position(along_m - speed_mps * back_s, across_m);
            let heading_rad = route.locate([x_m, y_m], None).heading_rad;
            let state = State { x_m, y_m, heading_rad, speed_mps };
            VehicleFrame { name: name.to_owned(), state, ..VehicleFrame::default() }
        };
        let mut contact = FirstContact::of(0, &vehicles);
        let end = ObservedMoment { time_s: 0.0, vehicles: &[], states: &[], along_m: &[] };
        for tick in 0..=20 {
            let back_s = f64::from(20 - tick) * 0.1;
            let between = [places[0].0, places[1].0].map(str::to_owned);
            let touch = Collision { time_s: 2.0, between, impulse_ns: 1.0 };
            let collisions = if tick == 20 { vec![touch] } else { Vec::new() };
            let vehicles = vec![at(0, back_s), at(1, back_s)];
            let frame = Frame { time_s: 2.0 - back_s, vehicles, collisions, ..Frame::default() };
            contact.observe(&ObservedTick {
                frame: &frame,
                step_s: 0.1,
                shared: &SharedStates::default(),
                previous_inputs: &[],
                end,
            });
        }
        contact.measured().value == Some(MetricValue::Flag(true))
    }

    /// The middle of the place where the routes of two vehicles meet, on the route of each \[m\].
    fn meeting_m(name: &str, vehicles: [&str; 2]) -> [f64; 2] {
        let scenario = interplay_scenarios::load(name, &[]).expect("authored");
        let [own, theirs] = vehicles.map(|vehicle| scenario.vehicle(vehicle).expect("authored"));
        let conflict = own.route.conflicts_with(&theirs.route).next().expect("they meet");
        [conflict.own_m, conflict.their_m].map(|[from_m, to_m]| 0.5 * (from_m + to_m))
    }

    /// The ego comes from the minor road. In a collision it had to wait, unless the other vehicle stood.
    #[test]
    fn the_vehicle_that_must_yield_is_at_fault() {
        let name = "t-junction/bayesian-nice";
        let [ego_m, main_m] = meeting_m(name, ["ego", "main"]);
        for [ego_mps, main_mps] in [[2.0, 10.0], [10.0, 2.0]] {
            let (ego, main) = (("ego", ego_m, 0.0, ego_mps), ("main", main_m, 0.0, main_mps));
            assert!(by_ego(name, [ego, main]), "{ego_mps} {main_mps}");
            assert!(!by_ego(name, [main, ego]), "{ego_mps} {main_mps}");
        }
        let (ego, main) = (("ego", ego_m, 0.0, 0.0), ("main", main_m, 0.0, 10.0));
        assert!(!by_ego(name, [ego, main]), "it has stood");
        assert!(by_ego(name, [main, ego]), "the other has stood");
    }

    /// Of two vehicles that meet head-on, the one in the other's lane is at fault at any speed.
    #[test]
    fn the_vehicle_in_the_lane_of_the_other_is_at_fault() {
        let name = "overtaking/oncoming";
        let scenario = interplay_scenarios::load(name, &[]).expect("authored");
        let length_m = scenario.vehicle("oncoming").expect("authored").route.end_m();
        for [ego_mps, other_mps] in [[5.0, 20.0], [20.0, 5.0]] {
            let ego = ("ego", 200.0, 3.5, ego_mps);
            let other = ("oncoming", length_m - 200.0, 0.0, other_mps);
            assert!(by_ego(name, [ego, other]), "{ego_mps}");
            assert!(!by_ego(name, [other, ego]), "{ego_mps}");
        }
    }
}
