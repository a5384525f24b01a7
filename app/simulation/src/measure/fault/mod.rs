//! Which vehicle is at fault in a contact, or owes another one a gap.
//!
//! The rules apply in this order:
//!
//! - a vehicle that has stood for a second of a real car is not at fault, on the lanes of a network;
//! - in a conflict of the two routes, the vehicle that must yield is at fault; where the first to arrive goes first, the one that had to
//!   wait;
//! - of two vehicles that meet head-on, the one outside its lane is at fault, if the other is in its own;
//! - among people, a vehicle that came into the way of one behind it with a shorter gap than it owes ([`owed_gap_m`](interplay_planners::scene::duties::owed_gap_m)) is at fault in the
//!   seconds after;
//! - otherwise, of two vehicles in one lane, the one behind is at fault, and of two others the one that approaches the other at least as
//!   fast as the other approaches it.

mod cut_in;
mod road_user;

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

use interplay_planners::State;
use interplay_planners::road::network::Precedence;
use interplay_scenarios::Vehicle;

use crate::state::frame::{ContactFault, Frame};
use crate::state::standing::STANDING_MPS;
use cut_in::{CutIn, CutIns};
use road_user::RoadUser;

/// What has to be remembered of a run to say which vehicle is at fault. Vehicles are numbered in the scenario's order.
#[derive(Clone, Debug)]
pub struct Faults {
    ego: usize,
    users: Vec<RoadUser>,
    index: BTreeMap<String, usize>,
    /// When a vehicle last had to wait for another one \[s\], by both.
    waited_s: BTreeMap<[usize; 2], f64>,
    cut_ins: CutIns,
}

impl Faults {
    /// Nothing has happened yet.
    pub fn new(vehicles: &[Vehicle], ego: usize) -> Self {
        Faults {
            ego,
            users: vehicles.iter().map(RoadUser::new).collect(),
            index: vehicles.iter().enumerate().map(|(index, vehicle)| (vehicle.name.clone(), index)).collect(),
            waited_s: BTreeMap::new(),
            cut_ins: CutIns::default(),
        }
    }

    /// Writes into the frame of a tick, after which the vehicles have these states, who is at fault in its contacts and who has come into
    /// a lane with a gap that is too short.
    pub fn observe(&mut self, frame: &mut Frame, after: &[State], step_s: f64) {
        self.remember(frame, step_s);
        self.cut_ins.note(&self.users, frame, after);
        let faults: Vec<Option<ContactFault>> =
            frame.collisions.iter().map(|contact| self.fault(frame, &contact.between)).collect();
        for (contact, fault) in frame.collisions.iter_mut().zip(faults) {
            contact.fault = fault;
        }
    }

    /// Updates standing times and duties to wait at the beginning of a tick.
    fn remember(&mut self, frame: &Frame, step_s: f64) {
        self.waited_s.retain(|pair, waited_s| frame.time_s - *waited_s <= self.users[pair[0]].remembered_s());
        for (user, vehicle) in self.users.iter_mut().zip(&frame.vehicles) {
            let stands = vehicle.state.speed_mps < STANDING_MPS * user.time_ratio();
            user.stood_s = if stands { user.stood_s + step_s } else { 0.0 };
        }
        for (index, vehicle) in frame.vehicles.iter().enumerate() {
            for name in &vehicle.rules.waits_for {
                if let Some(other) = self.index_of(name) {
                    self.waited_s.insert([index, other], frame.time_s);
                }
            }
        }
    }

    fn index_of(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    /// Which of two vehicles that touch is at fault; none if the frame does not have both.
    fn fault(&self, frame: &Frame, between: &[String; 2]) -> Option<ContactFault> {
        let [a, b] = between.each_ref().map(|name| self.index_of(name));
        let pair = [a?, b?];
        let vehicles = &frame.vehicles;
        let states = [&vehicles.get(pair[0])?.state, &vehicles.get(pair[1])?.state];
        let (of_first, why) = self.by_rule(pair, states).unwrap_or_else(|| self.by_motion(pair, states));
        let [at_fault, other] = if of_first { pair } else { [pair[1], pair[0]] };
        let [vehicle, other] = [at_fault, other].map(|index| self.users[index].name.clone());
        let why = match why {
            Why::CutIn(cut_in) => cut_in.sentence([&vehicle, &other]),
            Why::Words(words) => format!("{vehicle} {words} {other}"),
        };
        Some(ContactFault { vehicle, why })
    }

    /// Whether the first of two vehicles is at fault by a rule, and by which; none if no rule decides.
    fn by_rule(&self, pair: [usize; 2], states: [&State; 2]) -> Option<(bool, Why)> {
        let users = pair.map(|index| &self.users[index]);
        if users.iter().all(|user| user.route.is_in_network()) {
            match users.map(RoadUser::has_stood) {
                [true, false] => return Some((false, Why::Words("ran into the standing"))),
                [false, true] => return Some((true, Why::Words("ran into the standing"))),
                [true, true] | [false, false] => {}
            }
            if let Some(of_first) = self.by_precedence(pair, states) {
                return Some((of_first, Why::Words("did not give way to")));
            }
            if let Some(of_first) = by_lane(users, states) {
                return Some((of_first, Why::Words("was out of its lane and met")));
            }
        }
        let cut_in = |pair: [usize; 2], of_first: bool| Some((of_first, Why::CutIn(*self.cut_ins.of(pair)?)));
        cut_in(pair, true).or_else(|| cut_in([pair[1], pair[0]], false))
    }

    /// Whether the first vehicle had to yield, in a conflict that both have entered.
    fn by_precedence(&self, pair: [usize; 2], states: [&State; 2]) -> Option<bool> {
        let [own, theirs] = pair.map(|index| &self.users[index]);
        let near_m = own.length_m();
        let is_in = |user: &RoadUser, state: &State, [from_m, to_m]: [f64; 2]| {
            let [rear_m, front_m] = user.reach_m(state);
            front_m > from_m - near_m && rear_m < to_m
        };
        let here = own
            .route
            .conflicts_with(&theirs.route)
            .find(|conflict| is_in(own, states[0], conflict.own_m) && is_in(theirs, states[1], conflict.their_m))?;
        let waited = |pair: [usize; 2]| self.waited_s.get(&pair).copied();
        match (here.precedence, waited(pair), waited([pair[1], pair[0]])) {
            (Precedence::Own, ..) => Some(false),
            (Precedence::Other, ..) => Some(true),
            (Precedence::ByArrival, own_s, their_s) if own_s != their_s => Some(own_s > their_s),
            (Precedence::ByArrival, ..) => None,
        }
    }

    /// Of two vehicles in one lane the one behind, otherwise the one that drives into the other.
    fn by_motion(&self, pair: [usize; 2], states: [&State; 2]) -> (bool, Why) {
        let [own, theirs] = pair.map(|index| &self.users[index]);
        let [own_m, their_m] = states.map(|state| own.route.across(state.position()));
        let half_m = 0.5 * (own.body.width_m + theirs.body.width_m);
        let is_same_way = libm::cos(states[0].heading_rad - states[1].heading_rad) > FRAC_1_SQRT_2;
        let of_first = match [states[0].drives_into(states[1]), states[1].drives_into(states[0])] {
            [true, false] => true,
            [false, true] => false,
            // Of two that are equally to blame, the ego is; of two of which none is, the other one.
            [both, _] => both == (pair[0] == self.ego),
        };
        let words = if is_same_way && (own_m - their_m).abs() < half_m { "ran into the rear of" } else { "drove into" };
        (of_first, Why::Words(words))
    }
}

/// Why a vehicle is at fault.
#[derive(Clone, Copy, Debug)]
enum Why {
    CutIn(CutIn),
    /// Words between its name and that of the other.
    Words(&'static str),
}

/// Of two vehicles that meet head-on, whether the first is outside its lane and the second inside its own, or the reverse.
fn by_lane([own, theirs]: [&RoadUser; 2], states: [&State; 2]) -> Option<bool> {
    let is_head_on = libm::cos(states[0].heading_rad - states[1].heading_rad) < -FRAC_1_SQRT_2;
    match [own.is_out_of_lane(states[0]), theirs.is_out_of_lane(states[1])] {
        [own_is_out, they_are_out] if is_head_on && own_is_out != they_are_out => Some(own_is_out),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::{Scenario, load};

    use super::*;
    use crate::state::frame::{Collision, VehicleFrame};

    /// Vehicles of a scenario that drive for 2 s to their places along and across their routes and to their speeds; the first two touch
    /// there, or nothing does.
    fn driven(scenario: &Scenario, places: &[(&str, [f64; 2], f64)], touch: bool) -> Frame {
        let vehicles: Vec<Vehicle> =
            places.iter().map(|(name, ..)| scenario.vehicle(name).expect("a vehicle").clone()).collect();
        let state = |index: usize, back_s: f64| {
            let (_, [along_m, across_m], speed_mps) = places[index];
            let route = &vehicles[index].route;
            let [x_m, y_m] = route.position(along_m - speed_mps * back_s, across_m);
            State { x_m, y_m, heading_rad: route.locate([x_m, y_m], None).heading_rad, speed_mps }
        };
        let mut faults = Faults::new(&vehicles, 0);
        let mut last = Frame::default();
        for tick in 0..=20 {
            let back_s = f64::from(20 - tick) * 0.1;
            let of = |(index, vehicle): (usize, &Vehicle)| VehicleFrame {
                name: vehicle.name.clone(),
                state: state(index, back_s),
                ..VehicleFrame::default()
            };
            let between = [places[0].0, places[1].0].map(str::to_owned);
            let contact = Collision { time_s: 2.0, between, ..Collision::default() };
            last = Frame {
                time_s: 2.0 - back_s,
                vehicles: vehicles.iter().enumerate().map(of).collect(),
                collisions: if touch && tick == 20 { vec![contact] } else { Vec::new() },
                ..Frame::default()
            };
            let after: Vec<State> = (0..places.len()).map(|index| state(index, back_s)).collect();
            faults.observe(&mut last, &after, 0.1);
        }
        last
    }

    /// The name of the vehicle at fault in a contact of the first two.
    fn at_fault(name: &str, places: [(&str, f64, f64, f64); 2]) -> String {
        let scenario = load(name, &[]).expect("authored");
        let places = places.map(|(name, along_m, across_m, speed_mps)| (name, [along_m, across_m], speed_mps));
        let frame = driven(&scenario, &places, true);
        frame.collisions[0].fault.as_ref().expect("one is at fault").vehicle.clone()
    }

    #[test]
    fn on_a_road_without_rules_the_vehicle_behind_is_at_fault() {
        let at = |[ego_m, front_m]: [f64; 2]| {
            at_fault("lane-change/front-nice", [("ego", ego_m, 0.185, 0.6), ("front", front_m, 0.185, 0.5)])
        };
        assert_eq!([at([0.0, 0.42]), at([0.42, 0.0])], ["ego", "front"]);
    }

    /// The middle of the place where the routes of two vehicles meet, on the route of each \[m\].
    fn meeting_m(name: &str, vehicles: [&str; 2]) -> [f64; 2] {
        let scenario = load(name, &[]).expect("authored");
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
            assert_eq!(at_fault(name, [ego, main]), "ego", "{ego_mps} {main_mps}");
            assert_eq!(at_fault(name, [main, ego]), "ego", "{ego_mps} {main_mps}");
        }
        let (ego, main) = (("ego", ego_m, 0.0, 0.0), ("main", main_m, 0.0, 10.0));
        assert_eq!(at_fault(name, [ego, main]), "main", "the other has stood");
    }

    /// Of two vehicles that meet head-on, the one in the other's lane is at fault at any speed.
    #[test]
    fn the_vehicle_in_the_lane_of_the_other_is_at_fault() {
        let name = "overtaking/oncoming";
        let scenario = load(name, &[]).expect("authored");
        let length_m = scenario.vehicle("oncoming").expect("authored").route.end_m();
        for [ego_mps, other_mps] in [[5.0, 20.0], [20.0, 5.0]] {
            let ego = ("ego", 200.0, 3.5, ego_mps);
            let other = ("oncoming", length_m - 200.0, 0.0, other_mps);
            assert_eq!(at_fault(name, [ego, other]), "ego", "{ego_mps}");
            assert_eq!(at_fault(name, [other, ego]), "ego", "{ego_mps}");
        }
    }
}
