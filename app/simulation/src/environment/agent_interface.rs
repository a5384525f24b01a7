//! The interface between an agent and its vehicle: observations as numbers, and actions from numbers.

use std::fmt;
use std::sync::Arc;

use interplay_planners::perception::belief::{self, DriverBeliefs};
use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::scene::driver_estimate::DriverEstimate;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, Input, Plan, PlanError, Scene};
use thiserror::Error;

use super::action::{MetaTarget, handed_in, row_of};
use super::observation::{AgentView, ObservationSpace, Seen};
use super::{Action, ActionSpace, DiscreteMeta};
use crate::phases::external;
use crate::state::components::HandedIn;

/// The interface between an agent and its vehicle. It keeps beliefs about the other drivers, if a view shows them, and the target
/// of the meta-actions.
#[derive(Clone, Debug)]
pub struct AgentInterface {
    /// Each view with its number of numbers.
    views: Vec<(AgentView, usize)>,
    action: Action,
    horizon: usize,
    beliefs: Option<Box<DriverBeliefs>>,
    estimates: Vec<DriverEstimate>,
    target: Option<MetaTarget>,
    /// The plan that the vehicle follows between decisions, and the number of steps of it that have passed.
    followed: (Vec<f32>, usize),
}

impl AgentInterface {
    /// The interface of a vehicle with a planning horizon, before its first decision.
    pub fn new(observations: &[AgentView], action: Action, horizon: usize) -> AgentInterface {
        let infers = observations.iter().any(AgentView::shows_beliefs);
        AgentInterface {
            views: observations.iter().map(|view| (view.clone(), view.space(horizon).len())).collect(),
            action,
            horizon,
            beliefs: infers.then(|| Box::new(DriverBeliefs::new(belief::Settings::default()))),
            estimates: Vec::new(),
            target: None,
            followed: (Vec::new(), 0),
        }
    }

    /// The observation spaces of the views, in order.
    pub fn observation_spaces(&self) -> Vec<ObservationSpace> {
        self.views.iter().map(|(view, _)| view.space(self.horizon)).collect()
    }

    /// Number of numbers of an observation.
    pub fn observation_len(&self) -> usize {
        self.views.iter().map(|(_, length)| length).sum()
    }

    /// The space of actions.
    pub fn action_space(&self) -> ActionSpace {
        self.action.space(self.horizon)
    }

    /// Updates the beliefs from the sensed scene; must be called whenever the vehicle plans.
    pub fn look(&mut self, sensed: &SensedScene) {
        if let Some(beliefs) = &mut self.beliefs {
            self.estimates = beliefs.infer(sensed).estimates;
        }
    }

    /// Writes the observation; `out` has [`AgentInterface::observation_len`] numbers.
    pub fn observe(&self, scene: &Scene, out: &mut [f32]) {
        let seen = Seen { scene, beliefs: &self.estimates };
        let mut rest = out;
        for (view, length) in &self.views {
            let (own, others) = rest.split_at_mut(*length);
            view.write(&seen, own);
            rest = others;
        }
    }

    /// Takes a decision. Numbers are clipped to −1 and 1; an impossible meta-action changes nothing.
    ///
    /// # Errors
    /// What is wrong with the numbers.
    pub fn decide(&mut self, scene: &Scene, numbers: &[f32]) -> Result<(), String> {
        if let Some(fault) = self.action_space().fault(numbers) {
            return Err(fault);
        }
        if self.action == Action::DiscreteMeta {
            let target = self.target.unwrap_or_else(|| MetaTarget::of(scene));
            let action = DiscreteMeta::ALL[numbers[0] as usize];
            self.target = Some(target.after(action, scene).unwrap_or(target));
        } else {
            self.followed = (numbers.to_vec(), 0);
        }
        Ok(())
    }

    /// The input at this plan, from the last decision: of an older plan the remaining rows, and after these its last row.
    pub(crate) fn handed_in(&mut self, scene: &Scene) -> HandedIn {
        if let Some(target) = self.target {
            return HandedIn::Input(target.input(scene));
        }
        let (numbers, passed) = &mut self.followed;
        if numbers.is_empty() {
            return goes_on(scene);
        }
        let rows = numbers.len() / 2;
        let later = (0..rows).flat_map(|row| {
            let row = (row + *passed).min(rows - 1);
            [numbers[2 * row], numbers[2 * row + 1]]
        });
        let later: Vec<f32> = later.collect();
        *passed += 1;
        handed_in(self.action, &later, &scene.ego)
    }

    /// The possible meta-actions, by number; `None` for other kinds of action.
    pub fn action_mask(&self, scene: &Scene) -> Option<[bool; DiscreteMeta::COUNT]> {
        (self.action == Action::DiscreteMeta).then(|| {
            let target = self.target.unwrap_or_else(|| MetaTarget::of(scene));
            DiscreteMeta::ALL.map(|action| target.after(action, scene).is_some())
        })
    }

    /// The action that comes closest to a plan, so that a planner of Interplay can act through this interface.
    pub fn numbers_of(&self, scene: &Scene, plan: &Plan) -> Vec<f32> {
        let trajectory = &plan.trajectory;
        match self.action {
            Action::DiscreteMeta => {
                let target = self.target.unwrap_or_else(|| MetaTarget::of(scene));
                let end = trajectory.states.last().unwrap_or(&scene.ego.state);
                vec![target.nearest(scene, end) as usize as f32]
            }
            Action::Continuous | Action::Plan => {
                let rows = self.action_space().len() / 2;
                let inputs = (0..rows).map(|t| trajectory.inputs.get(t).or(trajectory.inputs.last()).copied());
                inputs.flat_map(|input| row_of(&input.unwrap_or_default(), &scene.ego)).collect()
            }
        }
    }
}

/// A vehicle without a decision continues along its lane at its present speed.
pub(super) fn goes_on(scene: &Scene) -> HandedIn {
    HandedIn::Input(MetaTarget::of(scene).input(scene))
}

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
