//! What a vehicle has committed itself to: what the others expect of it, and what it does when its planner fails.

use std::borrow::Cow;
use std::iter::repeat;
use std::sync::Arc;

use crate::plan::certificate::{as_spread, last_resorts, least_harmful, rolled_out};
use crate::prediction::{steadily_along, steady_inputs};
use crate::{Agent, Scene, Trajectory};

/// The plan that a vehicle follows since its last decision.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommittedPlan {
    /// The plan of the last tick, or the fallback in its place; none before the first.
    pub trajectory: Option<Arc<Trajectory>>,
    /// How many inputs of the last plan that the planner found are still to come.
    pub remaining_inputs: usize,
}

/// Where a plan comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// The planner found the plan.
    #[default]
    Planned,
    /// The planner failed: the previous plan goes on.
    Continued,
    /// The planner failed and there was nothing to continue that is less harmful: full braking.
    Braking,
    /// The planner failed, and another acceleration is less harmful than both.
    Evading,
    /// The vehicle has crashed: full braking, and its planner is not asked.
    Crashed,
}

impl CommittedPlan {
    /// What is expected of a vehicle before it has planned again: its plan one step further, from where it really
    /// is (a plant need not follow the plan exactly); before the first plan, constant velocity.
    pub fn prediction(&self, agent: &Agent, horizon: usize, step_s: f64) -> Trajectory {
        let Agent { route, body, state, .. } = agent;
        let Some(plan) = &self.trajectory else { return steadily_along(route, body, state, horizon, step_s) };
        let mut prediction = plan.shifted();
        if let Some(first) = prediction.states.first_mut() {
            *first = *state;
        }
        prediction
    }

    /// Commits the vehicle of `scene` to what its planner `found`, or to the fallback where that is nothing.
    pub(super) fn renew(
        &mut self,
        found: Option<&Trajectory>,
        is_crashed: bool,
        scene: &Scene,
    ) -> (Arc<Trajectory>, Origin) {
        let (trajectory, origin) = match found {
            _ if is_crashed => (braking(scene), Origin::Crashed),
            Some(found) => (found.clone(), Origin::Planned),
            None => self.fallback(scene),
        };
        self.remaining_inputs = match origin {
            Origin::Planned => trajectory.horizon().saturating_sub(1),
            Origin::Continued => self.remaining_inputs.saturating_sub(1),
            Origin::Braking | Origin::Evading | Origin::Crashed => 0,
        };
        let trajectory = Arc::new(trajectory);
        self.trajectory = Some(Arc::clone(&trajectory));
        (trajectory, origin)
    }

    /// The least harmful of the previous plan one step further, while inputs of it are left, and of the last resorts, of which
    /// full braking is the first. It is judged as the plan was that has been refused.
    fn fallback(&self, scene: &Scene) -> (Trajectory, Origin) {
        let judged = if scene.knowledge.is_of_motion() { Cow::Owned(as_spread(scene)) } else { Cow::Borrowed(scene) };
        let previous = self.trajectory.as_ref().filter(|_| self.remaining_inputs > 0);
        let continued = previous.map(|plan| rolled_out(scene, plan.shifted().inputs));
        let origins =
            continued.iter().map(|_| Origin::Continued).chain([Origin::Braking]).chain(repeat(Origin::Evading));
        let motions = continued.iter().cloned().chain(last_resorts(scene));
        let (number, motion) = least_harmful(&judged, motions).unwrap_or_else(|| (0, braking(scene)));
        (motion, origins.into_iter().nth(number).unwrap_or(Origin::Braking))
    }
}

/// Full braking until the vehicle stands.
fn braking(scene: &Scene) -> Trajectory {
    rolled_out(scene, steady_inputs(scene, scene.ego.limits.acceleration_min_mps2))
}
