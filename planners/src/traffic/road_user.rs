//! A vehicle with all that the loop keeps of it.

use std::sync::Arc;

use super::committed::{CommittedPlan, Origin};
use super::presence::{Presence, Stay};
use crate::drivers::reaction::Reaction;
use crate::rules::Obliged;
use crate::scene::record::Record;
use crate::{Agent, Goal, Input, Plan};

/// One vehicle of the closed loop: the only place where its state, its last input, its goal and its plan are kept.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadUser {
    /// The vehicle as the others see it: state, last input, body, limits, route, prediction and rules.
    pub agent: Agent,
    /// The goal of the vehicle.
    pub goal: Goal,
    /// Whether it plans before, and publishes its plan to, those that do not.
    pub goes_first: bool,
    /// Whether it knows the plans of the others that tell them; else it sees their motion only.
    pub knows_plans: bool,
    /// Whether it tells its plan, its goal and its wishes to those that know plans.
    pub tells_plan: bool,
    /// How late it observes the motion of the others \[s\].
    pub reaction_s: f64,
    /// How long it follows a slow vehicle before it overtakes on the other side, for 1/10 scale cars \[s\].
    pub patience_s: f64,
    /// Whether it decides for itself where it drives: it does not follow a script, a record or inputs from outside.
    pub decides: bool,
    /// Whether its driver may be asked for an input instead of a plan: it looks at nothing ahead.
    pub may_react: bool,
    /// Whether it is asked for an input in this tick.
    pub is_reacting: bool,
    /// The answer of a driver that has reacted; none before, and of others.
    pub reaction: Option<Reaction>,
    /// Whether it keeps all rules of the road, speed limits too, and drives no faster than it wants.
    pub keeps_rules: bool,
    /// Whether a collision left it unfit to drive: it brakes, and its planner is not asked.
    pub is_crashed: bool,
    /// Whether it is on the road now. The others do not see an absent vehicle, and its planner is not asked.
    pub presence: Presence,
    /// When the scenario wants it on the road.
    pub stay: Stay,
    /// The recorded motion that it carries out, whatever its inputs are; `None` for a vehicle that its inputs move.
    pub record: Option<Arc<Record>>,
    /// The plan that it decided on last.
    pub committed: CommittedPlan,
    /// The last decision with its reasons; after a failure, the fallback. Empty for a vehicle that made none.
    pub plan: Arc<Plan>,
    /// Where the plan comes from.
    pub origin: Origin,
}

impl RoadUser {
    /// A vehicle on the road that has not planned yet and knows the plans of the others.
    pub fn new(agent: Agent, goal: Goal, goes_first: bool) -> Self {
        RoadUser {
            agent,
            goal,
            goes_first,
            knows_plans: true,
            tells_plan: true,
            reaction_s: 0.0,
            patience_s: 0.0,
            decides: true,
            may_react: false,
            is_reacting: false,
            reaction: None,
            keeps_rules: false,
            is_crashed: false,
            presence: Presence::Present,
            stay: Stay::default(),
            record: None,
            committed: CommittedPlan::default(),
            plan: Arc::default(),
            origin: Origin::default(),
        }
    }

    /// Whether it is not on the road now.
    pub fn is_absent(&self) -> bool {
        self.presence.is_absent()
    }

    /// Whether it sees only the motion of the others, as people do; the drivers of the dissertation who infer plans see states.
    pub fn observes(&self) -> bool {
        !self.knows_plans && self.agent.limits.comfort.is_some()
    }

    /// The vehicle as the rules see it that it keeps itself.
    pub(super) fn obliged(&self) -> Obliged<'_> {
        Obliged {
            agent: &self.agent,
            wanted_mps: self.goal.target.speed_mps,
            lateral_goal_m: self.agent.route.across(self.goal.target.position()),
            keeps_rules: self.keeps_rules,
        }
    }

    /// How many steps late it observes the others.
    pub(super) fn late_steps(&self, step_s: f64) -> usize {
        (self.reaction_s / step_s).round().max(0.0) as usize
    }

    /// The input of its reaction, or the first of its plan.
    pub fn planned_input(&self) -> Input {
        if let Some(reaction) = &self.reaction {
            return reaction.input;
        }
        let planned = self.committed.trajectory.as_ref().and_then(|plan| plan.inputs.first());
        planned.copied().unwrap_or_default()
    }

    /// Whether a record moves it at this time, so that the others do not know its plan \[s\].
    pub(super) fn follows_record_at(&self, time_s: f64) -> bool {
        self.record.as_ref().is_some_and(|record| record.holds_at(time_s))
    }
}
