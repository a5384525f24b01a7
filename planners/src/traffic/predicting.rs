//! What is expected of all vehicles before they plan, what the rules of the road ask of them, and how urgent it is for them to brake.

use std::sync::Arc;

use super::Traffic;
use super::observation::{MadeOf, Observations};
use super::road_user::RoadUser;
use crate::Agent;
use crate::rules::giving_way::stopping_distance_m;
use crate::rules::{Obliged, RoadRules, beside_no_network};

impl Traffic {
    /// Writes into every agent what the others expect of it before it has planned in this tick, and what the rules of the road ask
    /// of it, and says how urgent it is for it to brake. To be called once a tick.
    pub fn predict(&mut self) {
        self.road_users.iter_mut().filter(|user| !user.is_absent()).for_each(|user| user.agent.note_place());
        if self.road_users.iter().any(|user| !user.is_absent() && !user.is_reacting) {
            self.find_neighbours();
            let Traffic { tick, step_s, .. } = *self;
            let present = self.road_users.iter().filter(|user| !user.is_absent());
            self.rule_book.note(tick, step_s, &present.map(RoadUser::obliged).collect::<Vec<_>>());
            self.observe();
            self.judge();
            self.expect();
        } else {
            self.observations = Observations::default();
        }
        self.prepare_reactions();
    }

    /// Writes into every agent that plans what the others expect of it, and how urgent it is for it to brake.
    fn expect(&mut self) {
        let Traffic { horizon, step_s, .. } = *self;
        for RoadUser { agent, committed, .. } in self.road_users.iter_mut().filter(|user| !user.is_reacting) {
            agent.prediction = Arc::new(committed.prediction(agent, horizon, step_s));
        }
        for vehicle in 0..self.road_users.len() {
            let RoadUser { agent, keeps_rules, presence, is_reacting, .. } = &self.road_users[vehicle];
            if presence.is_absent() || *is_reacting || (!keeps_rules && agent.limits.comfort.is_none()) {
                continue;
            }
            let (keeps_rules, observes) = (*keeps_rules, self.road_users[vehicle].observes());
            let mut scene = if observes { self.scene(vehicle) } else { self.moment(vehicle) };
            if keeps_rules {
                self.rule_book.hold_behind_obstacle(&mut scene, self.road_users[vehicle].patience_s);
            }
            if keeps_rules && self.road_users[vehicle].stay.stops_at_end {
                let before_m = stopping_distance_m(&scene.ego);
                scene.ego.rules.stop_before(scene.ego.route.end_m() - before_m);
            }
            if observes && self.road_users[vehicle].decides {
                scene.ego.rules.follows = scene.kept_behind();
            }
            let urgency = scene.urgency();
            self.road_users[vehicle].agent = Agent { urgency, ..scene.ego };
        }
    }

    /// Makes the observation of this tick and the views of those who see the motion of the others only.
    fn observe(&mut self) {
        let present = || self.road_users.iter().filter(|user| !user.is_absent());
        let observers = present().filter(|user| user.observes() && !user.is_reacting);
        let mut late: Vec<usize> = observers.map(|user| user.late_steps(self.step_s)).collect();
        late.sort_unstable();
        late.dedup();
        let Some(latest) = late.last().copied() else {
            self.observations = Observations::default();
            return;
        };
        let seen = present().map(|user| Obliged::as_seen(&user.agent, user.keeps_rules)).collect::<Vec<_>>();
        let mut asked = self.rule_book.judge(self.tick, self.step_s, &seen).into_iter();
        let rules = self
            .road_users
            .iter()
            .map(|user| if user.is_absent() { RoadRules::default() } else { asked.next().unwrap_or_default() });
        let made_of = self.made_of();
        let observation = made_of.observation(rules.collect(), latest, self.rule_book.arrivals().clone());
        let mut observations = std::mem::take(&mut self.observations);
        observations.note(observation, &late, &self.made_of());
        self.observations = observations;
    }

    pub(super) fn made_of(&self) -> MadeOf<'_> {
        let Traffic { tick, step_s, horizon, ref road_users, ref near, .. } = *self;
        MadeOf { tick, step_s, horizon, road_users, near }
    }

    /// Writes into every agent what the rules of the road ask of it: by the present of all, or, of one who sees the motion of the others
    /// only, by its own present and what it sees.
    fn judge(&mut self) {
        let Traffic { tick, step_s, .. } = *self;
        let is_present = |user: &RoadUser| !user.is_absent();
        let mut rules: Vec<Option<RoadRules>> = vec![None; self.road_users.len()];
        if self.road_users.iter().any(|user| is_present(user) && !user.observes()) {
            let present = || self.road_users.iter().filter(|user| is_present(user));
            let obliged: Vec<Obliged<'_>> = present().map(RoadUser::obliged).collect();
            let rows = self.road_users.iter().enumerate().filter(|(_, user)| is_present(user)).map(|(row, _)| row);
            for (row, asked) in rows.zip(self.rule_book.judge(tick, step_s, &obliged)) {
                rules[row] = Some(asked).filter(|_| !self.road_users[row].observes());
            }
        }
        for row in 0..self.road_users.len() {
            rules[row] = rules[row].take().or_else(|| self.asked_of_observer(row));
        }
        for (user, rules) in self.road_users.iter_mut().zip(rules) {
            if let Some(rules) = rules {
                user.agent.rules = rules;
            }
        }
    }

    /// What the rules ask of one who sees the motion of the others only.
    fn asked_of_observer(&self, row: usize) -> Option<RoadRules> {
        let (view, own) = (self.view(row)?, self.road_users[row].obliged());
        if !own.is_judged() {
            return Some(beside_no_network(own.keeps_rules));
        }
        let place = view.rows.iter().position(|other| *other == row)?;
        let seen = view.rows.iter().zip(&view.wanted_mps).filter_map(|(other, wanted_mps)| {
            let (agent, keeps_rules) = (view.agents[*other].as_ref()?, self.road_users[*other].keeps_rules);
            Some(Obliged { agent, wanted_mps: *wanted_mps, lateral_goal_m: 0.0, keeps_rules })
        });
        let users: Vec<Obliged<'_>> =
            seen.enumerate().map(|(index, user)| if index == place { own } else { user }).collect();
        Some(self.rule_book.judge_one(&view.order, &view.arrivals, &users, place, view.seen_s))
    }
}
