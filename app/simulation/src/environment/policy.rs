//! A policy as the driver of a vehicle in any run.

use std::fmt;
use std::sync::Arc;

use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, Input, Plan, PlanError, Scene};
use thiserror::Error;

use super::AgentInterface;
use crate::phases::external;
use crate::state::components::HandedIn;

/// A function from observations to actions, such as a trained network. The same observation gives the same action.
pub trait Policy: Send + Sync {
    /// The action for an observation: the numbers of the action's space.
    ///
    /// # Errors
    /// Why the policy has no action.
    fn act(&self, observation: &[f32]) -> Result<Vec<f32>, PolicyError>;
}

/// Why a policy has no action.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{0}")]
pub struct PolicyError(pub String);

/// A driver that applies a policy.
#[derive(Clone)]
pub struct PolicyDriver {
    policy: Arc<dyn Policy>,
    interface: AgentInterface,
    /// Number of plans from one decision to the next.
    plans_per_decision: usize,
    plans: usize,
}

impl PolicyDriver {
    /// A driver before its first decision.
    pub fn new(policy: Arc<dyn Policy>, interface: AgentInterface, plans_per_decision: usize) -> PolicyDriver {
        PolicyDriver { policy, interface, plans_per_decision, plans: 0 }
    }
}

impl fmt::Debug for PolicyDriver {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("PolicyDriver").field("interface", &self.interface).finish_non_exhaustive()
    }
}

impl Drive for PolicyDriver {
    /// # Errors
    /// [`PlanError::BadInput`] if the policy has no action, or an invalid one.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        self.interface.look(&SensedScene::perfect(scene));
        if self.plans.is_multiple_of(self.plans_per_decision) {
            let mut observation = vec![0.0; self.interface.observation_len()];
            self.interface.observe(scene, &mut observation);
            let numbers = self.policy.act(&observation).map_err(|error| PlanError::BadInput(error.0))?;
            self.interface
                .decide(scene, &numbers)
                .map_err(|fault| PlanError::BadInput(format!("the action {fault}")))?;
        }
        self.plans += 1;
        external::plan(self.interface.handed_in(scene), scene)
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }
}

/// A plan of the strongest braking straight ahead.
pub(super) fn braking(scene: &Scene) -> Plan {
    let input = Input { acceleration_mps2: scene.ego.limits.acceleration_min_mps2, steering_rad: 0.0 };
    external::plan(HandedIn::Plan(vec![input; scene.horizon]), scene).unwrap_or_default()
}
