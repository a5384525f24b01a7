//! The rules of the road: what they ask of each vehicle now, worked out once a tick from where everybody is.
//!
//! [`RuleBook::judge`] looks at all vehicles of a network together and says of each where it must wait and for whom
//! ([`RoadRules`]). It is part of the traffic and not of a driver, so all drivers are asked the same, whoever they are. Drivers who
//! keep the rules find the answer on their [`Agent`](crate::Agent): as a speed that no plan may exceed (`speed_caps`) and as a line.
//!
//! A vehicle waits at the line before a conflict ([`RouteConflict`](crate::road::network::RouteConflict))
//!
//! - until it has stood there once, if the sign says so,
//! - while somebody who goes first comes so soon that it could not clear the conflict before,
//! - while somebody who goes first has stopped there first, because it waits for a third one,
//! - while somebody is in the conflict, or past the own line towards it,
//! - where the first to arrive goes first, while somebody waits who came before.
//!
//! A vehicle that is past its line, or could no longer stop before it, goes on. Where vehicles wait for one another in a circle, the
//! first to arrive goes; of two who arrive at once, the one to the right of the other, and else by the direction in which it comes.

mod arrivals;
mod right_of_way;
mod waiting;

use arrivals::Arrivals;
pub(crate) use right_of_way::is_standing;
use right_of_way::{Arrived, Pair, can_stop, signed_lines, stopping_distance_m};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Agent;
use crate::traffic::RoadUser;

/// Whether a vehicle keeps the rules of the road: speed limits, stop signs and right of way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RuleKeeping {
    /// It keeps all of them, whoever drives it, drives no faster than it wants, and passes what stands in its way.
    Kept,
    /// It keeps none of them, for studies of who yields; humans and drivers after the intelligent driver model still keep right of way.
    Ignored,
}

/// What the rules of the road ask of a vehicle now.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoadRules {
    /// Whether its driver keeps all of them, speed limits too, and drives no faster than it wants.
    pub are_kept: bool,
    /// How far along its route the front may come now; none if nothing holds it \[m\].
    pub stop_line_m: Option<f64>,
    /// Whom it waits for there; empty where a sign alone holds it.
    pub waits_for: Vec<String>,
}

/// What has to be remembered of the past to judge the present: who has arrived where, and when.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RuleBook {
    arrivals: Arrivals,
}

/// One vehicle that another one has to wait for, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hold {
    by: usize,
    line_m: f64,
}

impl Agent {
    /// Whether the rules hold another vehicle for this one.
    pub(crate) fn is_waited_for_by(&self, other: &Agent) -> bool {
        other.rules.waits_for.contains(&self.name)
    }

    /// Whether the rules say which of two vehicles goes first now: there is nothing to negotiate.
    pub(crate) fn has_order_with(&self, other: &Agent) -> bool {
        self.is_waited_for_by(other) || other.is_waited_for_by(self)
    }
}

impl RoadRules {
    /// Its front has to stay before one more line \[m\].
    pub(crate) fn stop_before(&mut self, line_m: f64) {
        self.stop_line_m = Some(self.stop_line_m.map_or(line_m, |nearest_m| nearest_m.min(line_m)));
    }
}

impl RuleBook {
    /// What is asked of each of some road users, in their order. To be called once a tick.
    pub(crate) fn judge(&mut self, (tick, step_s): (usize, f64), users: &[RoadUser]) -> Vec<RoadRules> {
        if !users.iter().any(|user| user.keeps_rules && user.agent.route.is_in_network()) {
            return users.iter().map(|_| RoadRules::default()).collect();
        }
        self.arrivals.note_all((tick, step_s), users);
        let mut holds: Vec<Vec<Hold>> = (0..users.len()).map(|vehicle| self.holds(users, vehicle)).collect();
        let turns: Vec<_> = users.iter().map(|user| self.arrivals.turn(&user.agent)).collect();
        waiting::release(&mut holds, &turns);
        let asked = |(user, holds): (&RoadUser, &Vec<Hold>)| self.asked(user, users, holds);
        users.iter().zip(&holds).map(asked).collect()
    }

    /// Everybody that a vehicle has to wait for, judged in pairs.
    fn holds(&self, users: &[RoadUser], vehicle: usize) -> Vec<Hold> {
        let ego = &users[vehicle].agent;
        if !ego.route.is_in_network() {
            return Vec::new();
        }
        let wanted_mps = users[vehicle].goal.target.speed_mps;
        let mut found = Vec::new();
        for (by, other) in users.iter().enumerate().filter(|(by, _)| *by != vehicle) {
            for conflict in ego.route.conflicts_with(&other.agent.route) {
                let arrived = Arrived {
                    own: self.arrivals.has_arrived(ego),
                    their: self.arrivals.has_arrived(&other.agent),
                    they_came_first: self.arrivals.came_before([&other.agent, ego]),
                    they_are_ready: self.arrivals.is_ready(other),
                };
                let before_m = conflict.own_line_m - stopping_distance_m(ego);
                let pair = Pair::new([ego, &other.agent], conflict, wanted_mps);
                if can_stop(ego, before_m) && pair.holds(arrived) {
                    found.push(Hold { by, line_m: conflict.own_line_m });
                }
            }
        }
        found
    }

    /// What is asked of a vehicle that is held by others.
    fn asked(&self, user: &RoadUser, users: &[RoadUser], holds: &[Hold]) -> RoadRules {
        let ego = &user.agent;
        if !user.keeps_rules || !ego.route.is_in_network() {
            return RoadRules::default();
        }
        let before_m = stopping_distance_m(ego);
        let signs = signed_lines(ego).into_iter().filter(|line_m| !self.arrivals.has_stood_at(ego, *line_m));
        let signs = signs.filter(|line_m| can_stop(ego, line_m - before_m));
        let lines = signs.chain(holds.iter().map(|hold| hold.line_m));
        let nearest_m = lines.min_by(f64::total_cmp);
        let mut waits_for: Vec<String> = Vec::new();
        for hold in holds.iter().filter(|hold| Some(hold.line_m) == nearest_m) {
            let name = &users[hold.by].agent.name;
            if !waits_for.contains(name) {
                waits_for.push(name.clone());
            }
        }
        RoadRules { are_kept: user.keeps_rules, stop_line_m: nearest_m.map(|line_m| line_m - before_m), waits_for }
    }
}
