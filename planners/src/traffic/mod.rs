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
mod deciding;
mod limits;
mod neighbours;
mod observation;
mod planning_order;
mod predicting;
mod presence;
mod reacting;
#[cfg(test)]
mod reacting_tests;
mod road_user;
mod room;
mod scenes;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::{Plan, Trajectory};
pub use committed::{CommittedPlan, Origin};
pub use deciding::{Decided, Decision};
pub use limits::applied_input;
pub use neighbours::Neighbours;
pub use observation::Observations;
pub use planning_order::planning_order;
pub use presence::{Presence, Stay};
pub use reacting::Reacting;
pub use road_user::RoadUser;

use crate::rules::{RoadRules, RuleBook};
use crate::scene::LaneOrder;
use crate::trajectory::Statistics;

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
    /// The vehicles of a straight road by lanes, for drivers that react.
    pub lane_order: LaneOrder,
    /// Those that react in this tick.
    pub reacting: Reacting,
}

impl Traffic {
    /// Prepares every road user for the plan number `tick`, which is made at `time_s` \[s\]: predictions, rules and decisions of the
    /// last one are cleared. A vehicle that follows a record is expected to keep its speed, whatever it planned before.
    pub fn begin_plan(&mut self, tick: usize, time_s: f64) {
        (self.tick, self.near) = (tick, Neighbours::default());
        let nothing = (Trajectory::default(), Plan::default());
        let mut shared: Option<(Arc<Trajectory>, Arc<Plan>)> = None;
        for user in &mut self.road_users {
            if *user.agent.prediction != nothing.0 || *user.plan != nothing.1 {
                let (prediction, plan) = shared.get_or_insert_default();
                (user.agent.prediction, user.plan) = (Arc::clone(prediction), Arc::clone(plan));
            }
            (user.agent.rules, user.agent.urgency) = (RoadRules::default(), 1.0);
            user.origin = Origin::default();
            user.reaction = None;
            if user.follows_record_at(time_s) {
                user.committed = CommittedPlan::default();
            }
        }
        self.let_react();
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
}
