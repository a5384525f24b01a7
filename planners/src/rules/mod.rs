//! The rules of the road: what they ask of each vehicle now, worked out once a tick from the states of all vehicles.
//!
//! `RuleBook::judge` looks at all vehicles of a network together and says of each where it must wait and for which vehicles
//! ([`RoadRules`]). It is part of the traffic and not of a driver, so they ask the same of all kinds of drivers. Drivers who
//! keep the rules find the answer on their [`Agent`](crate::Agent): as a speed that no plan may exceed (`speed_caps`) and as a line.
//!
//! A vehicle waits at the line before a conflict ([`RouteConflict`](crate::road::network::RouteConflict))
//!
//! - while a traffic light there is red, or amber if it can stop in comfort,
//! - until it has stood there once, if the sign says so,
//! - while a vehicle that goes first comes so soon that it could not clear the conflict before,
//! - while a vehicle that goes first has stopped there first, because it waits for a third one,
//! - while it could not leave a way that crosses its own, for want of room behind,
//! - while a vehicle is in the conflict, or past the own line towards it,
//! - where the first to arrive goes first, while a vehicle waits that came before.
//!
//! Into the lane beside it, as from an acceleration lane, a vehicle merges without standing (`merging`).
//!
//! A vehicle that is past its line, or could no longer stop before it, goes on. Where vehicles wait for one another in a circle, the
//! first to arrive goes; of two who arrive at once, the one to the right of the other, and else by the direction in which it comes.

mod arrivals;
pub(crate) mod giving_way;
mod keep_clear;
mod lane;
mod lights;
mod merging;
mod obliged;
pub(crate) mod obstacle;
mod overtaking;
mod queue;
pub(crate) mod right_of_way;
pub(crate) mod urgency;
mod waiting;
mod wrong_way;

pub(crate) use arrivals::Arrivals;
pub(crate) use obliged::Obliged;

use std::collections::BTreeMap;

use crate::Scene;
use crate::rules::giving_way::{Arrived, Pair, can_stop, signed_lines, stopping_distance_m};
use crate::rules::obstacle::{Manoeuvre, ObstacleMemory};
use crate::rules::overtaking::Overtaking;
use crate::scene::relation::is_standing;
pub use crate::scene::road_rules::{Merging, Obstacle, RoadRules, RuleKeeping};
use waiting::Hold;

/// What has to be remembered of the past to judge the present: which vehicle has arrived where, and when.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RuleBook {
    arrivals: Arrivals,
    /// Of each who keeps the rules: what stands in its way.
    obstacles: BTreeMap<String, ObstacleMemory>,
    /// Of each among people who keeps the rules: which slow vehicle it overtakes.
    overtaking: BTreeMap<String, Overtaking>,
}

impl RuleBook {
    /// Notes which vehicles have arrived where. To be called once a tick.
    pub(crate) fn note(&mut self, tick: usize, step_s: f64, users: &[Obliged<'_>]) {
        if are_judged(users) {
            self.arrivals.note_all(tick, step_s, users);
        }
    }

    /// What is asked of each of some road users, in their order.
    pub(crate) fn judge(&self, tick: usize, step_s: f64, users: &[Obliged<'_>]) -> Vec<RoadRules> {
        if !are_judged(users) {
            return users.iter().map(|user| beside_no_network(user.keeps_rules)).collect();
        }
        let time_s = tick as f64 * step_s;
        let mut order = Order::of(&self.arrivals, users, time_s);
        waiting::release(&mut order.holds, &order.turns);
        let asked = |(vehicle, user): (usize, &Obliged<'_>)| {
            let asked = asked(&self.arrivals, user, users, &order.holds[vehicle], time_s);
            RoadRules { lets_in: order.lets_in(vehicle), ..asked }
        };
        users.iter().enumerate().map(asked).collect()
    }

    /// What is asked of one road user, number `vehicle` of `users`, who observed the others some time ago and knows its own present:
    /// `order` and `arrivals` are those that it observed, of the others as they are expected to be now. The lights are those of
    /// `seen_s` \[s\].
    pub(crate) fn judge_one(
        &self,
        order: &Order,
        arrivals: &Arrivals,
        users: &[Obliged<'_>],
        vehicle: usize,
        seen_s: f64,
    ) -> RoadRules {
        let user = &users[vehicle];
        let mut held = held([&self.arrivals, arrivals], users, vehicle, &order.lights_m);
        // A vehicle that waits for no other is in no circle.
        if !held.is_empty() {
            let (mut holds, mut turns) = (order.holds.clone(), order.turns.clone());
            (holds[vehicle], turns[vehicle]) = (held, self.arrivals.turn(user.agent));
            waiting::release(&mut holds, &turns);
            held = holds.swap_remove(vehicle);
        }
        RoadRules { lets_in: order.lets_in(vehicle), ..asked(&self.arrivals, user, users, &held, seen_s) }
    }

    /// What has been noted of arrivals so far.
    pub(crate) fn arrivals(&self) -> &Arrivals {
        &self.arrivals
    }

    /// Adds what an obstacle asks of the planning vehicle of a scene, if it keeps the rules: it leaves its lane for it only while no
    /// vehicle comes. Before a vehicle that comes head-on in its lane, it brakes and goes to the edge. `patience_s` is how long it follows a
    /// slow vehicle before it overtakes, for 1/10 scale cars \[s\]. To be called once a tick.
    pub(crate) fn hold_behind_obstacle(&mut self, scene: &mut Scene, patience_s: f64) {
        let evasion = wrong_way::evasion(scene);
        if let Some(evasion) = &evasion {
            scene.ego.rules.stop_before(evasion.line_m);
            scene.ego.rules.evades = Some(evasion.name.clone());
            scene.drive_beside_goal(evasion.across_m);
        }
        let memory = self.obstacles.entry(scene.ego.name.clone()).or_default();
        if let Some(other_lane_m) = overtaking::other_lane_m(&scene.ego).filter(|_| scene.knowledge.is_of_motion()) {
            let overtaking = self.overtaking.entry(scene.ego.name.clone()).or_default();
            let overtakes_at_m = overtaking.judge(scene, patience_s, other_lane_m).filter(|_| evasion.is_none());
            scene.ego.rules.stays_in_lane = overtakes_at_m.is_none() && lane::is_in_lane(&scene.ego);
            let returns = evasion.is_none() && memory.passing().is_none() && !scene.ego.rules.stays_in_lane;
            if let Some(across_m) = overtakes_at_m.or(returns.then_some(0.0)) {
                scene.drive_beside_goal(across_m);
            }
        }
        match memory.judge(scene) {
            Some(Manoeuvre::Wait(obstacle, waits_for)) => {
                let line_m = obstacle.line_m(scene);
                scene.ego.rules.stop_before(line_m);
                scene.ego.rules.waits_for.extend(waits_for);
            }
            Some(Manoeuvre::Pass(obstacle)) => {
                scene.ego.rules.stays_in_lane = false;
                scene.ego.rules.passes = Some(obstacle);
            }
            None => {}
        }
    }
}

/// Whether the rules of a network are kept by any vehicle.
fn are_judged(users: &[Obliged<'_>]) -> bool {
    users.iter().any(Obliged::is_judged)
}

/// Which vehicles have to wait for which, before circles are broken.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Order {
    /// The lights at which each has to stop \[m\].
    lights_m: Vec<Option<f64>>,
    holds: Vec<Vec<Hold>>,
    turns: Vec<Option<(usize, f64)>>,
    /// Which of them let one in that merges.
    let_in: Vec<bool>,
}

impl Order {
    /// The order of some road users at a time, with what is known of their arrivals \[s\].
    pub(crate) fn of(arrivals: &Arrivals, users: &[Obliged<'_>], time_s: f64) -> Order {
        let lights_m: Vec<Option<f64>> = users.iter().map(|user| lights::line_m(user.agent, time_s)).collect();
        let held = |vehicle: usize| held([arrivals; 2], users, vehicle, &lights_m);
        let holds = (0..users.len()).map(held).collect();
        let turns = users.iter().map(|user| arrivals.turn(user.agent)).collect();
        Order { lights_m, holds, turns, let_in: merging::let_in(users) }
    }

    fn lets_in(&self, vehicle: usize) -> bool {
        self.let_in.get(vehicle).is_some_and(|lets_in| *lets_in)
    }
}

/// All vehicles that a vehicle has to wait for, judged in pairs; `lights_m` are the lights at which each has to stop. What is known of
/// its own arrival and of those of the others may be of different times.
fn held([own, their]: [&Arrivals; 2], users: &[Obliged<'_>], vehicle: usize, lights_m: &[Option<f64>]) -> Vec<Hold> {
    let ego = &users[vehicle].agent;
    if !ego.route.is_in_network() {
        return Vec::new();
    }
    let wanted_mps = users[vehicle].wanted_mps;
    let mut found = Vec::new();
    for (by, other) in users.iter().enumerate().filter(|(by, _)| *by != vehicle) {
        for conflict in ego.route.conflicts_with(&other.agent.route) {
            // A vehicle that must stop at a light before the conflict does not arrive there.
            if lights_m[by].is_some_and(|line_m| line_m <= conflict.their_m[0]) {
                continue;
            }
            // Into the lane beside it merges without standing.
            if merging::is_from_beside(ego, other.agent, conflict) && !is_standing(other.agent) {
                continue;
            }
            let arrived = Arrived {
                own: own.has_arrived(ego),
                their: their.has_arrived(other.agent),
                they_came_first: arrivals::came_before([their.turn(other.agent), own.turn(ego)]),
                they_are_ready: their.is_ready(other),
                they_win_ties: false,
            };
            let before_m = conflict.own_line_m - stopping_distance_m(ego);
            let pair = Pair::new([ego, other.agent], conflict, wanted_mps, is_standing(other.agent));
            if can_stop(ego, before_m) && pair.holds(arrived) {
                found.push(Hold { by, line_m: conflict.own_line_m });
            }
        }
    }
    found
}

/// What is asked of a vehicle that is held by others.
fn asked(arrivals: &Arrivals, user: &Obliged<'_>, users: &[Obliged<'_>], holds: &[Hold], time_s: f64) -> RoadRules {
    let ego = &user.agent;
    if !user.is_judged() {
        return beside_no_network(user.keeps_rules);
    }
    let before_m = stopping_distance_m(ego);
    let is_lit = |line_m: &f64| lights::is_lit(ego, *line_m, time_s);
    let signs = signed_lines(ego).into_iter().filter(|line_m| !is_lit(line_m) && !arrivals.has_stood_at(ego, *line_m));
    let signs = signs.filter(|line_m| can_stop(ego, line_m - before_m));
    let others = users.iter().map(|other| other.agent).filter(|other| other.name != ego.name);
    let clear = keep_clear::line_m(ego, others);
    let lines = signs.chain(holds.iter().map(|hold| hold.line_m)).chain(lights::line_m(ego, time_s));
    let lines = lines.chain(clear.map(|(line_m, _)| line_m));
    let nearest_m = lines.min_by(f64::total_cmp);
    let mut waits_for: Vec<String> = Vec::new();
    for hold in holds.iter().filter(|hold| Some(hold.line_m) == nearest_m) {
        let name = &users[hold.by].agent.name;
        if !waits_for.contains(name) {
            waits_for.push(name.clone());
        }
    }
    let stays_in_lane = lane::stays_in_lane(user, users);
    let stop_line_m = nearest_m.map(|line_m| line_m - before_m);
    let keeps_clear_behind =
        clear.filter(|(line_m, _)| Some(*line_m) == nearest_m).map(|(_, ahead)| ahead.name.clone());
    let (are_kept, merging) = (user.keeps_rules, merging::merging(user, users));
    RoadRules { are_kept, stays_in_lane, stop_line_m, waits_for, keeps_clear_behind, merging, ..RoadRules::default() }
}

/// What is asked where a road has no signs and no lanes that meet: to drive no faster than one wants in order to be first.
pub(crate) fn beside_no_network(are_kept: bool) -> RoadRules {
    RoadRules { are_kept, ..RoadRules::default() }
}
