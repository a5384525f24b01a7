//! A vehicle with all that the loop keeps of it.

use super::committed::CommittedPlan;
use crate::{Agent, Goal, Input};

/// One vehicle of the closed loop: how the others see it, its goal, and its committed plan.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadUser {
    /// The vehicle as all others see it.
    pub agent: Agent,
    /// The goal of the vehicle.
    pub goal: Goal,
    /// Whether it plans before all others and publishes its plan to them.
    pub goes_first: bool,
    /// Whether it knows the plans of the others.
    pub knows_plans: bool,
    /// Whether it keeps all rules of the road, speed limits too, and drives no faster than it wants.
    pub keeps_rules: bool,
    /// Whether a collision left it unfit to drive: it brakes, and its planner is not asked.
    pub is_crashed: bool,
    /// Whether it is not on the road now: it has not come yet, or has left. No driver sees it, and its planner is not asked.
    pub is_absent: bool,
    /// The plan that it decided on last.
    pub committed: CommittedPlan,
}

impl RoadUser {
    /// A vehicle that has not planned yet and knows the plans of the others.
    pub fn new(agent: Agent, goal: Goal, goes_first: bool) -> Self {
        RoadUser {
            agent,
            goal,
            goes_first,
            knows_plans: true,
            keeps_rules: false,
            is_crashed: false,
            is_absent: false,
            committed: CommittedPlan::default(),
        }
    }

    /// The first input of its plan.
    pub fn planned_input(&self) -> Input {
        let planned = self.committed.trajectory.as_ref().and_then(|plan| plan.inputs.first());
        planned.copied().unwrap_or_default()
    }
}
