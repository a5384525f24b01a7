//! What vehicles decide that plan, in which order and in which sets.

use std::sync::Arc;

use super::Traffic;
use super::committed::{CommittedPlan, Origin};
use super::limits::applied_input;
use super::planning_order::planning_order;
use super::road_user::RoadUser;
use crate::{Bicycle, Input, Plan, PlanError, Scene, Trajectory};

/// What one vehicle decided in a tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The index of the vehicle among the road users.
    pub vehicle: usize,
    /// The plan that is carried out: the planner's, or a fallback without diagnostics and events.
    pub plan: Arc<Plan>,
    /// Where the plan comes from.
    pub origin: Origin,
    /// Why the planner found none, if it was asked and failed.
    pub failure: Option<PlanError>,
}

/// The decision of a vehicle before it is carried out.
#[derive(Clone, Debug)]
pub struct Decided {
    committed: CommittedPlan,
    trajectory: Arc<Trajectory>,
    plan: Arc<Plan>,
    origin: Origin,
    failure: Option<PlanError>,
}

impl Traffic {
    /// Lets every driver on the road decide; returns the decisions in the order in which they were made.
    ///
    /// `ask` is given the index of a vehicle and its scene, and answers with what the vehicle's planner does. Afterwards the
    /// predictions of drivers that go first are their plans.
    pub fn plan(&mut self, mut ask: impl FnMut(usize, &Scene) -> Result<Plan, PlanError>) -> Vec<Decision> {
        self.plan_in_sets(|traffic, rows| rows.iter().map(|row| traffic.decide(*row, &mut ask)).collect())
    }

    /// The same by sets of vehicles whose decisions do not depend on each other: `decide` answers for all vehicles of a set, in their
    /// order, with [`Traffic::decide`] of each. Those who see the motion of the others only know no plan of this tick, so consecutive ones
    /// are a set.
    pub fn plan_in_sets(&mut self, mut decide: impl FnMut(&Traffic, &[usize]) -> Vec<Decided>) -> Vec<Decision> {
        let plans = |row: &usize| !self.road_users[*row].is_absent() && self.road_users[*row].reaction.is_none();
        let some_plan = (0..self.road_users.len()).any(|row| plans(&row));
        let order = if some_plan { planning_order(&self.road_users) } else { Vec::new() };
        let order: Vec<usize> = order.into_iter().filter(plans).collect();
        let both_observe = |one: &usize, next: &usize| [one, next].iter().all(|row| self.road_users[**row].observes());
        let sets: Vec<Vec<usize>> = order.chunk_by(both_observe).map(<[usize]>::to_vec).collect();
        let mut decisions = Vec::with_capacity(order.len());
        for set in sets {
            for (row, decided) in set.iter().zip(decide(self, &set)) {
                decisions.push(self.commit(*row, decided));
            }
        }
        self.indicate();
        decisions
    }

    /// Vehicles whose plans are not told indicate a change of lane from the next tick on.
    fn indicate(&mut self) {
        let step_s = self.step_s;
        for user in self.road_users.iter_mut().filter(|user| !user.tells_plan && !user.is_absent()) {
            if let Some(lateral_m) = user.reaction.as_ref().filter(|_| user.decides).map(|reaction| reaction.lateral_m)
            {
                user.agent.indicator = lateral_m.and_then(|lateral_m| user.agent.indicates_towards(lateral_m));
                continue;
            }
            let planned = user.plan.announced.as_ref().or(user.committed.trajectory.as_deref());
            user.agent.indicator = user.agent.indicates(planned.filter(|_| user.decides), step_s);
        }
    }

    /// What a vehicle decides, given what its planner does with its scene; carried out by [`Traffic::plan_in_sets`].
    pub fn decide(&self, vehicle: usize, ask: impl FnOnce(usize, &Scene) -> Result<Plan, PlanError>) -> Decided {
        let (scene, user) = (self.scene(vehicle), &self.road_users[vehicle]);
        let outcome = if user.is_crashed { None } else { Some(ask(vehicle, &scene)) };
        let (plan, failure) = match outcome {
            Some(Ok(plan)) => (Some(plan), None),
            Some(Err(error)) => (None, Some(error)),
            None => (None, None),
        };
        let found = plan.as_ref().map(|plan| &plan.trajectory);
        let mut committed = user.committed.clone();
        let (trajectory, origin) = committed.renew(found, user.is_crashed, &scene);
        let plan = plan.unwrap_or_else(|| Plan { trajectory: (*trajectory).clone(), ..Plan::default() });
        Decided { committed, trajectory, plan: Arc::new(plan), origin, failure }
    }

    fn commit(&mut self, vehicle: usize, decided: Decided) -> Decision {
        let Decided { committed, trajectory, plan, origin, failure } = decided;
        let user = &mut self.road_users[vehicle];
        user.committed = committed;
        if user.goes_first {
            user.agent.prediction = trajectory;
        }
        (user.plan, user.origin) = (Arc::clone(&plan), origin);
        Decision { vehicle, plan, origin, failure }
    }

    /// The input that each vehicle applies after planning: the first one of its plan, within its limits.
    pub(super) fn applied_inputs(&self) -> Vec<Input> {
        let applied = |user: &RoadUser| {
            let agent = &user.agent;
            applied_input(&user.planned_input(), &agent.state, &agent.body, &agent.limits, self.step_s)
        };
        self.road_users.iter().map(applied).collect()
    }

    /// One tick with the bicycle as the plant: all predict, plan, act and move. Returns the decisions in the order
    /// in which they were made.
    pub fn drive(&mut self, ask: impl FnMut(usize, &Scene) -> Result<Plan, PlanError>) -> Vec<Decision> {
        self.predict();
        let decisions = self.plan(ask);
        let inputs = self.applied_inputs();
        self.advance(&inputs);
        decisions
    }

    /// Moves all vehicles by one tick with the bicycle as the plant.
    pub fn advance(&mut self, inputs: &[Input]) {
        for (RoadUser { agent, .. }, input) in self.road_users.iter_mut().zip(inputs) {
            agent.state = Bicycle::new(&agent.body, self.step_s).step(&agent.state, input);
            agent.previous_input = *input;
        }
        self.tick += 1;
    }
}
