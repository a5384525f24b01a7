//! The vehicles whose drivers react instead of planning: what they see, what the rules ask of them, and how urgent it is.
//!
//! A driver reacts if its kind does ([`DriverKind::reacts`](crate::DriverKind::reacts)), it sees the motion of the others only, and no
//! plan of it is told: then nothing but its input can be known of its decision. It reacts where all vehicles of a run are on one straight road
//! without obstacles, on which it sees the others by lanes, however far away they are ([`LaneOrder`]). On networks, where roads cross, and
//! where obstacles are passed, it plans over the horizon like the others.

use super::Traffic;
use super::road_user::RoadUser;
use crate::drivers::reaction::Reaction;
use crate::rules::beside_no_network;
use crate::rules::urgency::{braking_behind, ratio_to_comfort};
use crate::scene::lane_order::{LaneOrder, OnRoad, OnStraightRoad, Strip};
use crate::scene::{Knowledge, Moment};
use crate::{Agent, Scene};

/// The vehicles that react in a tick, and their answers while they are asked. Memory is kept from tick to tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reacting {
    rows: Vec<usize>,
    answers: Vec<Option<Reaction>>,
}

impl Traffic {
    /// Decides which vehicles react in this tick.
    pub(super) fn let_react(&mut self) {
        let agents = || self.road_users.iter().map(|user| &user.agent);
        let is_laned = self.road_users.iter().any(|user| user.may_react)
            && agents().all(|agent| !agent.is_obstacle)
            && LaneOrder::has_all(agents());
        for user in &mut self.road_users {
            user.is_reacting = is_laned && user.may_react && user.observes() && !user.tells_plan;
        }
    }

    /// Prepares what the reacting drivers see, what the rules ask of them, and how urgent it is for them to brake.
    pub(super) fn prepare_reactions(&mut self) {
        self.reacting.rows.clear();
        let users = self.road_users.iter().enumerate();
        let reacting = users.filter(|(_, user)| user.is_reacting && !user.is_absent());
        self.reacting.rows.extend(reacting.map(|(row, _)| row));
        if self.reacting.rows.is_empty() {
            return;
        }
        self.lane_order.sort(self.road_users.iter().map(|user| (!user.is_absent()).then_some(&user.agent)));
        for number in 0..self.reacting.rows.len() {
            let row = self.reacting.rows[number];
            let urgency = self.lane_order.of(row).map_or(1.0, |road| self.urgency_on(&road));
            let RoadUser { agent, keeps_rules, .. } = &mut self.road_users[row];
            (agent.rules, agent.urgency) = (beside_no_network(*keeps_rules), urgency);
        }
    }

    /// The urgency of a vehicle: of the vehicle ahead in its way.
    fn urgency_on(&self, road: &OnStraightRoad<'_>) -> f64 {
        let (agent, own) = (&self.road_users[road.own.row].agent, road.own);
        let way = Strip { centre_m: own.across_m, width_m: own.width_m };
        let behind =
            |(leader, gap_m): (&OnRoad, f64)| braking_behind(agent, gap_m, leader.speed_mps, leader.acceleration_mps2);
        ratio_to_comfort(agent, road.ahead(way).map_or(0.0, behind))
    }

    /// Asks every reacting driver on the road for its input. `ask` adds the answers of some rows, in their order: no answer depends on
    /// another one. A driver without an answer plans like the others.
    pub fn react(&mut self, ask: impl FnOnce(&Traffic, &[usize], &mut Vec<Option<Reaction>>)) {
        let mut reacting = std::mem::take(&mut self.reacting);
        reacting.rows.retain(|row| !self.road_users[*row].is_crashed);
        if !reacting.rows.is_empty() {
            ask(self, &reacting.rows, &mut reacting.answers);
        }
        for (row, answer) in reacting.rows.iter().zip(reacting.answers.drain(..)) {
            self.road_users[*row].reaction = answer;
        }
        self.reacting = reacting;
    }

    /// What a driver answers that reacts to what its vehicle can see now.
    pub fn at_moment<T>(&self, row: usize, answer: impl FnOnce(&Moment<'_>) -> T) -> T {
        let RoadUser { agent, goal, .. } = &self.road_users[row];
        let scene = || self.scene_to_react(row);
        answer(&Moment { own: agent, goal, step_s: self.step_s, road: self.lane_order.of(row), scene: &scene })
    }

    /// The moment as a scene of one step for a driver that reacts, with all others as they can be seen.
    fn scene_to_react(&self, row: usize) -> Scene {
        let others = self.road_users.iter().enumerate().filter(|(other, user)| *other != row && !user.is_absent());
        let others: Vec<Agent> = others.map(|(other, _)| self.shown(other)).collect();
        let knowledge = Knowledge::Motion { late_steps: 0 };
        Scene { others, horizon: 1, knowledge, ..self.moment_of(row, &[]) }
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
