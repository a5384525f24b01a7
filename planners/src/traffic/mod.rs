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
//! A driver that infers plans ([`RoadUser::knows_plans`]) knows none: its scene has the states of the others only. A driver of people
//! ([`RoadUser::observes`]) knows none either: its scene has the [`Observations`] of one reaction time ago, driven on to the present, and
//! the rules that it obeys are judged from them.

mod committed;
mod limits;
mod neighbours;
mod observation;
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
pub use observation::Observations;
pub use planning_order::planning_order;
pub use presence::{Presence, Stay};
pub use road_user::RoadUser;

use crate::prediction::without_plan;
use crate::rules::giving_way::stopping_distance_m;
use crate::rules::{Obliged, RoadRules, RuleBook, beside_no_network};
use crate::scene::Knowledge;
use crate::trajectory::Statistics;
use crate::{Agent, Bicycle, Input, Plan, PlanError, Scene, Trajectory};
use observation::{MadeOf, View};

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
    /// What drivers see who do not know plans.
    pub observations: Observations,
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
        let present = self.road_users.iter().filter(|user| !user.is_absent());
        self.rule_book.note(tick, step_s, &present.map(RoadUser::obliged).collect::<Vec<_>>());
        self.observe();
        self.judge();
        for RoadUser { agent, committed, .. } in &mut self.road_users {
            agent.prediction = Arc::new(committed.prediction(agent, horizon, step_s));
        }
        for vehicle in 0..self.road_users.len() {
            let RoadUser { agent, keeps_rules, presence, .. } = &self.road_users[vehicle];
            if presence.is_absent() || (!keeps_rules && agent.limits.comfort.is_none()) {
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
        let observers = present().filter(|user| user.observes());
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

    fn made_of(&self) -> MadeOf<'_> {
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
            return Some(beside_no_network(&own));
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

    /// What a vehicle on the road sees that observes the motion of the others only; none of another one.
    fn view(&self, row: usize) -> Option<&View> {
        let user = &self.road_users[row];
        (user.observes() && !user.is_absent())
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

    /// The moment as it is around one vehicle, with the predictions as they stand of all who can matter to it within the horizon.
    pub fn moment(&self, vehicle: usize) -> Scene {
        self.moment_of(vehicle, &self.near.of(vehicle, &self.road_users))
    }

    fn moment_of(&self, vehicle: usize, others: &[usize]) -> Scene {
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

    /// Lets every driver on the road decide; returns the decisions in the order in which they were made.
    ///
    /// `ask` is given the index of a vehicle and its scene, and answers with what the vehicle's planner does. Afterwards the
    /// predictions of drivers that go first are their plans.
    pub fn plan(&mut self, mut ask: impl FnMut(usize, &Scene) -> Result<Plan, PlanError>) -> Vec<Decision> {
        let order = planning_order(&self.road_users);
        let present = order.into_iter().filter(|vehicle| !self.road_users[*vehicle].is_absent()).collect::<Vec<_>>();
        let decisions = present.into_iter().map(|vehicle| self.decide(vehicle, &mut ask)).collect();
        self.indicate();
        decisions
    }

    /// Vehicles whose plans are not told indicate a change of lane from the next tick on.
    fn indicate(&mut self) {
        let step_s = self.step_s;
        for user in self.road_users.iter_mut().filter(|user| !user.tells_plan && !user.is_absent()) {
            let planned = user.plan.announced.as_ref().or(user.committed.trajectory.as_deref());
            user.agent.indicator = user.agent.indicates(planned.filter(|_| user.decides), step_s);
        }
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
