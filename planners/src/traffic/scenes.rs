//! The moment as each vehicle sees it.

use std::sync::Arc;

use super::Traffic;
use super::observation::{View, as_it_shows};
use super::road_user::RoadUser;
use crate::prediction::without_plan;
use crate::rules::beside_no_network;
use crate::scene::Knowledge;
use crate::{Agent, Input, Scene, Trajectory};

impl Traffic {
    /// What a vehicle on the road sees that observes the motion of the others only; none of another one.
    pub(super) fn view(&self, row: usize) -> Option<&View> {
        let user = &self.road_users[row];
        (user.observes() && !user.is_reacting && !user.is_absent())
            .then(|| self.observations.view_of(user.late_steps(self.step_s)))
            .flatten()
    }

    /// The motion that the others expect of a vehicle without delay: of one that does not tell its plan, what its motion leads to expect.
    pub fn expected_of(&self, row: usize) -> &Arc<Trajectory> {
        let RoadUser { agent, tells_plan, .. } = &self.road_users[row];
        let seen = if *tells_plan { None } else { self.observations.expected_of(row) };
        seen.unwrap_or(&agent.prediction)
    }

    /// The moment as one vehicle sees it: with the plans of those that tell them if it knows plans.
    pub fn scene(&self, vehicle: usize) -> Scene {
        let user = &self.road_users[vehicle];
        let Some(view) = self.view(vehicle) else {
            if user.is_reacting {
                return self.scene_without_answer(vehicle);
            }
            let near = self.near.of(vehicle, &self.road_users).into_iter();
            let known = near.map(|other| {
                let RoadUser { agent, tells_plan, .. } = &self.road_users[other];
                if user.knows_plans && *tells_plan {
                    return agent.clone();
                }
                let seen = self.observations.present_of(other, self.horizon).filter(|_| !tells_plan);
                seen.unwrap_or_else(|| without_plan(agent.clone(), self.horizon, self.step_s))
            });
            return Scene { others: known.collect(), ..self.moment_of(vehicle, &[]) };
        };
        let near = view.near.near_to(&user.agent, vehicle, |other| view.agents[other].as_ref());
        let others = near.into_iter().filter_map(|other| view.agents[other].clone()).collect();
        let knowledge = Knowledge::Motion { late_steps: user.late_steps(self.step_s) };
        Scene { others, knowledge, ..self.moment_of(vehicle, &[]) }
    }

    /// The moment as a vehicle sees it whose driver was to react and gave no answer: without delay, with what is expected of the others.
    fn scene_without_answer(&self, vehicle: usize) -> Scene {
        let rules = self.road_users.iter().map(|user| beside_no_network(user.keeps_rules)).collect();
        let seen = self.made_of().observation(rules, 0, self.rule_book.arrivals().clone());
        let others = seen.agents.iter().enumerate().filter(|(other, _)| *other != vehicle);
        let others = others.filter_map(|(_, agent)| agent.as_deref().cloned()).collect();
        let knowledge = Knowledge::Motion { late_steps: 0 };
        Scene { others, knowledge, ..self.moment_of(vehicle, &[]) }
    }

    /// The moment as it is around one vehicle, with the predictions as they stand of all who can matter to it within the horizon.
    pub fn moment(&self, vehicle: usize) -> Scene {
        self.moment_of(vehicle, &self.near.of(vehicle, &self.road_users))
    }

    pub(super) fn moment_of(&self, vehicle: usize, others: &[usize]) -> Scene {
        let RoadUser { agent, goal, .. } = &self.road_users[vehicle];
        let (agent, mut goal) = (agent.clone(), *goal);
        if let Some(across_m) = agent.rules.drives_at_m {
            goal = goal.moved_to(&agent.route, across_m);
        }
        Scene {
            tick: self.tick,
            step_s: self.step_s,
            horizon: self.horizon,
            knowledge: Knowledge::Plans,
            ego: agent,
            goal,
            others: others.iter().map(|other| self.road_users[*other].agent.clone()).collect(),
        }
    }

    /// A vehicle as it can be seen, without what is expected of it.
    pub(super) fn shown(&self, row: usize) -> Agent {
        let RoadUser { agent, tells_plan, .. } = &self.road_users[row];
        Agent {
            previous_input: Input { steering_rad: 0.0, ..agent.previous_input },
            shared_goal: agent.shared_goal.filter(|_| *tells_plan),
            can_be_asked: !agent.is_obstacle,
            rules: as_it_shows(agent, agent.rules.clone()),
            prediction: Arc::default(),
            ..agent.clone()
        }
    }
}
