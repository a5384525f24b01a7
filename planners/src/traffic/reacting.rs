//! The vehicles whose drivers react instead of planning: what they see, what the rules ask of them, and how urgent it is.
//!
//! A driver reacts if its kind does ([`DriverKind::reacts`](crate::DriverKind::reacts)), it sees the motion of the others only, and no
//! plan of it is told: then nothing but its input can be known of its decision.
//!
//! On straight roads a reacting driver sees the vehicles of its road by lanes, however far away they are ([`LaneOrder`](crate::scene::LaneOrder)). On networks
//! it sees those within [`SIGHT_S`], and the one ahead on its route however far away.

use super::Traffic;
use super::reactive_sight::ReactiveSight;
use super::road_user::{AskedFor, RoadUser};
use crate::drivers::reaction::Reaction;
use crate::rules::urgency::{braking_behind, ratio_to_comfort};
use crate::rules::{Obliged, Order, beside_no_network};
use crate::scene::lane_order::{OnRoad, OnStraightRoad, Strip};
use crate::scene::relation::is_standing;
use crate::scene::{Knowledge, Moment};
use crate::{Agent, PlanError, Scene};

/// How far ahead a driver on a network sees all vehicles: those that it can meet within this time of real cars \[s\].
const SIGHT_S: f64 = 8.0;

impl Traffic {
    /// The rows of the vehicles on the road that react.
    pub(super) fn reacting(&self) -> impl Iterator<Item = usize> + '_ {
        let users = self.road_users.iter().enumerate();
        users.filter(|(_, user)| user.is_reacting() && !user.is_absent()).map(|(row, _)| row)
    }

    /// Whether any vehicle on the road looks at the motion of the others in order to plan.
    pub(super) fn is_observed(&self) -> bool {
        let looks = |user: &RoadUser| user.asked_for != AskedFor::Nothing && !user.is_reacting() && !user.is_absent();
        self.road_users.iter().any(looks)
    }

    /// Prepares what the reacting drivers see, what the rules ask of them, and how urgent it is for them to brake.
    pub(super) fn prepare_reactions(&mut self) {
        let rows: Vec<usize> = self.reacting().collect();
        let Some(first) = rows.first() else { return };
        let mut lane_order = std::mem::take(&mut self.lane_order);
        lane_order.sort(self.road_users.iter().map(|user| (!user.is_absent()).then_some(&user.agent)));
        self.lane_order = lane_order;
        if rows.iter().any(|row| self.lane_order.of(*row).is_none()) {
            let sight_s = SIGHT_S * self.road_users[*first].agent.body.real_ratio().sqrt();
            self.sight = ReactiveSight::find(&self.road_users, sight_s);
        }
        for row in rows {
            let urgency = match self.lane_order.of(row) {
                Some(road) => self.urgency_on(&road),
                None => self.urgency_among(row),
            };
            self.road_users[row].agent.urgency = urgency;
        }
    }

    /// What the rules ask of the vehicles that see the motion of the others only and have no view of an earlier time: those that react, and
    /// those that are driven from outside while no other vehicle is observed.
    pub(super) fn judge_by_present(&mut self) {
        let is_observed = self.is_observed();
        let sees_present = |user: &RoadUser| user.is_reacting() || user.observes() && !is_observed;
        let rows: Vec<usize> = (0..self.road_users.len())
            .filter(|row| !self.road_users[*row].is_absent() && sees_present(&self.road_users[*row]))
            .collect();
        if !rows.iter().any(|row| self.road_users[*row].is_judged()) {
            for row in rows {
                let rules = beside_no_network(self.road_users[row].keeps_rules);
                self.road_users[row].agent.rules = rules;
            }
            return;
        }
        let present: Vec<usize> = (0..self.road_users.len()).filter(|row| !self.road_users[*row].is_absent()).collect();
        let seen = present.iter().map(|row| &self.road_users[*row]);
        let mut users: Vec<Obliged<'_>> = seen.map(|user| Obliged::as_seen(&user.agent, user.keeps_rules)).collect();
        let (time_s, arrivals) = (self.tick as f64 * self.step_s, self.rule_book.arrivals());
        let order = Order::of(arrivals, &users, time_s);
        let mut asked = Vec::with_capacity(rows.len());
        for (place, row) in present.iter().enumerate().filter(|(_, row)| rows.binary_search(row).is_ok()) {
            let own = self.road_users[*row].obliged();
            if !own.is_judged() {
                asked.push((*row, beside_no_network(own.keeps_rules)));
                continue;
            }
            let others_see = std::mem::replace(&mut users[place], own);
            asked.push((*row, self.rule_book.judge_one(&order, arrivals, &users, place, time_s)));
            users[place] = others_see;
        }
        for (row, rules) in asked {
            self.road_users[row].agent.rules = rules;
        }
    }

    /// The urgency of a vehicle on a straight road: of the vehicle ahead in its way.
    fn urgency_on(&self, road: &OnStraightRoad<'_>) -> f64 {
        let (agent, own) = (&self.road_users[road.own.row].agent, road.own);
        let way = Strip { centre_m: own.across_m, width_m: own.width_m };
        let behind =
            |(leader, gap_m): (&OnRoad, f64)| braking_behind(agent, gap_m, leader.speed_mps, leader.acceleration_mps2);
        ratio_to_comfort(agent, road.ahead(way, |_| true).map_or(0.0, behind))
    }

    /// The urgency of a vehicle on a network, with what an obstacle asks of it.
    fn urgency_among(&mut self, row: usize) -> f64 {
        let mut scene = self.scene_to_react(row);
        if self.road_users[row].keeps_rules {
            self.rule_book.hold_behind_obstacle(&mut scene);
        }
        let Scene { ego, others, .. } = &scene;
        let behind = ego.leader_among(others).map_or(0.0, |leader| {
            let gap_m = ego.lead_of(leader) - ego.body.front_m - leader.body.rear_m;
            braking_behind(ego, gap_m, leader.state.speed_mps, leader.previous_input.acceleration_mps2)
        });
        let urgency = ratio_to_comfort(ego, behind.max(ego.braking_before_line_mps2()));
        self.road_users[row].agent.rules = scene.ego.rules;
        urgency
    }

    /// Asks every reacting driver on the road for its input. `ask` answers for several rows at once, in their order: no answer depends on
    /// another one. A driver without an answer plans like the others.
    pub fn react(&mut self, ask: impl FnOnce(&Traffic, &[usize]) -> Vec<Result<Reaction, PlanError>>) {
        let rows: Vec<usize> = self.reacting().filter(|row| !self.road_users[*row].is_crashed).collect();
        if rows.is_empty() {
            return;
        }
        for (row, answer) in rows.iter().zip(ask(self, &rows)) {
            self.road_users[*row].reaction = answer.ok();
        }
    }

    /// What a driver answers that reacts to what its vehicle can see now.
    pub fn at_moment<T>(&self, row: usize, answer: impl FnOnce(&Moment<'_>) -> T) -> T {
        let RoadUser { agent, goal, .. } = &self.road_users[row];
        let scene = || self.scene_to_react(row);
        answer(&Moment { own: agent, goal, step_s: self.step_s, road: self.lane_order.of(row), scene: &scene })
    }

    /// The moment as a scene for a driver that reacts: with a horizon of one step, and over the whole horizon where a vehicle stands that may
    /// have to be passed.
    fn scene_to_react(&self, row: usize) -> Scene {
        let others: Vec<Agent> =
            self.sight.of(row, &self.road_users).into_iter().map(|other| self.shown(other)).collect();
        let may_pass = self.road_users[row].agent.route.is_in_network() && others.iter().any(is_standing);
        let horizon = if may_pass { self.horizon } else { 1 };
        let knowledge = Knowledge::Motion { late_steps: 0 };
        Scene { others, horizon, knowledge, ..self.moment_of(row, &[]) }
    }

    /// The plans of one step of the vehicles that have reacted, for reports and recordings.
    pub fn describe_reactions(&mut self) {
        for user in &mut self.road_users {
            if let Some(reaction) = &user.reaction {
                user.plan = reaction.to_plan(&user.agent, self.step_s);
            }
        }
    }
}
