//! The closed loop of vehicles that plan and move together, as pure functions of plain values.
//!
//! One tick is
//!
//! ```text
//! sense     Traffic::begin_plan       predictions, rules and decisions of the last plan are cleared
//! predict   Traffic::predict          each vehicle is expected to continue its last plan, from where it really is
//! plan      Traffic::plan             each driver decides, in `planning_order`; failures fall back
//! act       Traffic::applied_inputs   the first input of each plan, within the limits
//! move      a plant of the caller, or the bicycle: Traffic::advance
//! ```
//!
//! and [`Traffic::drive`] is a whole tick with the bicycle as the plant.
//!
//! There are no clocks, entities or threads here. The application, the tests, the examples and the benchmarks run this code;
//! a caller that wants to know how long planning takes measures inside the closure that it gives to [`Traffic::plan`].
//!
//! **Who knows which plan.** Those who go first ([`RoadUser::goes_first`]) plan from the front of the road to its rear and
//! publish their plans at once. All the others plan afterwards and know these plans (the source's assumption of perfect
//! prediction); of one another they know the last plans only, so that no decision depends on which driver was asked before in the
//! same tick. Sums and the search over homotopy classes still go through the others as they are listed: reversed, they differ in
//! rounding, and in a near-tie by more (`docs/evidence/reliability.md`).
//! A driver that infers plans ([`RoadUser::knows_plans`]) knows none: its scene has the states of the others only.

mod committed;
mod limits;
mod neighbours;
mod planning_order;
mod presence;
mod road_user;
mod room;
#[cfg(test)]
mod tests;

use std::sync::Arc;

pub use committed::{CommittedPlan, Origin};
pub use limits::applied_input;
pub use neighbours::Neighbours;
pub use planning_order::planning_order;
pub use presence::{Presence, Stay};
pub use road_user::RoadUser;

use crate::prediction::without_plans;
use crate::rules::{Obliged, RoadRules, RuleBook};
use crate::trajectory::Statistics;
use crate::{Agent, Bicycle, Input, Plan, PlanError, Scene};

/// All road users at the start of a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traffic {
    /// How many ticks have passed.
    pub tick: usize,
    /// Length of a tick, which is also the time step of plans \[s\].
    pub step_s: f64,
    /// Number of steps of a plan.
    pub horizon: usize,
    /// The road users, in the order in which they are listed.
    pub road_users: Vec<RoadUser>,
    /// What has to be remembered in order to judge by the rules of the road; carried on from tick to tick.
    pub rule_book: RuleBook,
    /// Who is near whom; before they are found, all count as near.
    pub near: Neighbours,
}

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

impl Traffic {
    /// Prepares every road user for the plan number `tick`, which is made at `time_s` \[s\]: predictions, rules and decisions of the
    /// last one are cleared. A vehicle that follows a record is expected to keep its speed, whatever it planned before.
    pub fn begin_plan(&mut self, tick: usize, time_s: f64) {
        (self.tick, self.near) = (tick, Neighbours::default());
        let (prediction, plan) = (Arc::default(), Arc::default());
        for user in &mut self.road_users {
            user.agent.prediction = Arc::clone(&prediction);
            (user.agent.rules, user.agent.urgency) = (RoadRules::default(), 1.0);
            (user.plan, user.origin) = (Arc::clone(&plan), Origin::default());
            if user.follows_record_at(time_s) {
                user.committed = CommittedPlan::default();
            }
        }
    }

    /// The road users follow their last plans for another tick: what happened while they planned is not reported again.
    pub fn follow_plans(&mut self) {
        for user in &mut self.road_users {
            if !user.plan.events.is_empty() || user.plan.statistics != Statistics::default() {
                let plan = Arc::make_mut(&mut user.plan);
                plan.events.clear();
                plan.statistics = Statistics::default();
            }
        }
    }

    /// Finds out which vehicles can matter to which, from where all are now.
    pub fn find_neighbours(&mut self) {
        self.near = Neighbours::find(&self.road_users, self.horizon_s());
    }

    fn horizon_s(&self) -> f64 {
        self.horizon as f64 * self.step_s
    }

    /// Writes into every agent what the others expect of it before it has planned in this tick, and what the rules of the road ask
    /// of it, and says how urgent it is for it to brake. To be called once a tick.
    pub fn predict(&mut self) {
        self.find_neighbours();
        let Traffic { tick, horizon, step_s, .. } = *self;
        let present = || self.road_users.iter().filter(|user| !user.is_absent());
        let obliged = present().map(|user| Obliged {
            agent: &user.agent,
            wanted_mps: user.goal.target.speed_mps,
            lateral_goal_m: user.agent.route.across(user.goal.target.position()),
            keeps_rules: user.keeps_rules,
        });
        let rules = self.rule_book.judge(tick, step_s, &obliged.collect::<Vec<_>>());
        for (user, rules) in self.road_users.iter_mut().filter(|user| !user.is_absent()).zip(rules) {
            user.agent.rules = rules;
        }
        for RoadUser { agent, committed, .. } in &mut self.road_users {
            agent.prediction = Arc::new(committed.prediction(agent, horizon, step_s));
        }
        for vehicle in 0..self.road_users.len() {
            let RoadUser { agent, keeps_rules, presence, .. } = &self.road_users[vehicle];
            if presence.is_absent() || (!keeps_rules && agent.limits.comfort.is_none()) {
                continue;
            }
            let (keeps_rules, mut scene) = (*keeps_rules, self.moment(vehicle));
            if keeps_rules {
                self.rule_book.hold_behind_obstacle(&mut scene);
            }
            let urgency = scene.urgency();
            self.road_users[vehicle].agent = Agent { urgency, ..scene.ego };
        }
    }

    /// The moment as one vehicle sees it: with the plans of the others if it knows them.
    pub fn scene(&self, vehicle: usize) -> Scene {
        let scene = self.moment(vehicle);
        if self.road_users[vehicle].knows_plans { scene } else { without_plans(scene) }
    }

    /// The moment as it is around one vehicle, with the predictions as they stand of all who can matter to it within the horizon.
    pub fn moment(&self, vehicle: usize) -> Scene {
        let others = self.near.of(vehicle, &self.road_users);
        Scene {
            tick: self.tick,
            step_s: self.step_s,
            horizon: self.horizon,
            ego: self.road_users[vehicle].agent.clone(),
            goal: self.road_users[vehicle].goal,
            others: others.into_iter().map(|other| self.road_users[other].agent.clone()).collect(),
        }
    }

    /// Lets every driver on the road decide; returns the decisions in the order in which they were made.
    ///
    /// `ask` is given the index of a vehicle and its scene, and answers with what the vehicle's planner does. Afterwards the
    /// predictions of drivers that go first are their plans.
    pub fn plan(&mut self, mut ask: impl FnMut(usize, &Scene) -> Result<Plan, PlanError>) -> Vec<Decision> {
        let order = planning_order(&self.road_users);
        let present = order.into_iter().filter(|vehicle| !self.road_users[*vehicle].is_absent()).collect::<Vec<_>>();
        present.into_iter().map(|vehicle| self.decide(vehicle, &mut ask)).collect()
    }

    fn decide(&mut self, vehicle: usize, ask: impl FnOnce(usize, &Scene) -> Result<Plan, PlanError>) -> Decision {
        let scene = self.scene(vehicle);
        let user = &mut self.road_users[vehicle];
        let outcome = if user.is_crashed { None } else { Some(ask(vehicle, &scene)) };
        let (plan, failure) = match outcome {
            Some(Ok(plan)) => (Some(plan), None),
            Some(Err(error)) => (None, Some(error)),
            None => (None, None),
        };
        let found = plan.as_ref().map(|plan| &plan.trajectory);
        let (trajectory, origin) = user.committed.renew(found, user.is_crashed, &scene);
        if user.goes_first {
            user.agent.prediction = Arc::clone(&trajectory);
        }
        let plan = plan.unwrap_or_else(|| Plan { trajectory: (*trajectory).clone(), ..Plan::default() });
        let plan = Arc::new(plan);
        (user.plan, user.origin) = (Arc::clone(&plan), origin);
        Decision { vehicle, plan, origin, failure }
    }

    /// The input that each vehicle applies after planning: the first one of its plan, within its limits.
    fn applied_inputs(&self) -> Vec<Input> {
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
