//! Cooperation (section 6.2): all vehicles with this driver solve one joint problem.
//!
//! ```text
//! minimise    Σ_i 1/Z_i Σ_t (‖x_i − x_i,des‖²_Q + ‖Δu_i‖²_R)                                           (6.6)
//! subject to  the bicycle model, bounds and road of each vehicle, and the safety ellipses of each pair    (6.7-6.11)
//! ```
//!
//! `x_i` is the state of vehicle `i`, `x_i,des` its desired state, `Δu_i` the change of its input from step to step, `Q`
//! and `R` its weights, and `Z_i` its normaliser. With positive weights `1/Z_i` a global optimum is Pareto optimal: no cost
//! can fall unless another rises. The source has two vehicles; here any number may cooperate.
//!
//! The planner is decentralised. Every vehicle publishes its goal ([`crate::Agent::shared_goal`]), solves the joint problem itself, and
//! applies its own part of the solution. The computation is deterministic and the vehicles are ordered by name, so all
//! solutions are bit-identical as long as all vehicles have the same information.
//!
//! Among people no plan or goal is told, and the joint problem without other vehicles is that of the conservative planner; the planner says
//! so. Vehicles with `tells_plan = true` cooperate.
//!
//! The starting guess determines which vehicle goes first. So at the first step the planner tries, for each vehicle, the guess
//! in which it accelerates and the others brake.

pub mod diagnostics;
mod settings;

use std::sync::Arc;

pub use settings::Settings;

use crate::drivers::conservative;
use crate::drivers::drive::StandardReplacement;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::plan::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::problem::{JointVehicle, joint_problem};
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::activity::Activity;
use crate::trajectory::{Optimiser, Optimum, Problem, Robust, Violation};
use crate::{Diagnostic, Goal, Input, Plan, PlanError, PlanEvent, PlanTime, Proposal, Scene, Trajectory};
use diagnostics::{COOPERATING_VEHICLES, OWN_COST};

/// The vehicles of the joint problem with their goals, sorted by name: each of these vehicles computes a bit-identical
/// list.
pub fn cooperators(scene: &Scene, own: Goal) -> Vec<JointVehicle> {
    let others = scene.others.iter().filter_map(|agent| Some((agent, agent.shared_goal?)));
    let all = others.chain([(&scene.ego, own)]);
    let mut found: Vec<JointVehicle> = all.map(|(agent, goal)| JointVehicle { agent: agent.clone(), goal }).collect();
    found.sort_by(|a, b| a.agent.name.cmp(&b.agent.name));
    found
}

/// The cooperative planner (eq. 6.12) with its last joint plan.
#[derive(Clone, Debug)]
pub struct Cooperative {
    settings: Settings,
    optimiser: Optimiser<Robust>,
    /// The last trajectory of each cooperating vehicle, with its name.
    last: Vec<(String, Trajectory)>,
    /// Whether the last plan was made with no other vehicle, because none is linked.
    was_alone: bool,
}

impl Settings {
    /// The goal that a vehicle with these settings publishes: its own goal with weights divided by its normaliser `Z_i`.
    pub fn shared_goal(&self, goal: &Goal) -> Goal {
        let share = 1.0 / self.normaliser;
        let (tracking, comfort) = (goal.tracking.map(|q| share * q), goal.comfort.map(|r| share * r));
        Goal { tracking, comfort, ..*goal }
    }
}

impl Cooperative {
    /// A planner that has not planned yet.
    pub fn new(settings: Settings) -> Self {
        Cooperative {
            settings,
            optimiser: Optimiser::receding_horizon(Robust::default()).searching(settings.passing_orders),
            last: Vec::new(),
            was_alone: false,
        }
    }

    /// Says once when no vehicle is linked, and the joint problem is the conservative one. Among vehicles that tell their plans, the
    /// diagnostic with the number of vehicles says as much.
    fn remark(&mut self, scene: &Scene, vehicles: usize) -> Option<PlanEvent> {
        let is_alone = scene.knowledge.is_of_motion() && vehicles == 1;
        let remark = (is_alone && !self.was_alone)
            .then(|| PlanEvent::note("no other vehicle is linked: plans are those of the conservative planner"));
        self.was_alone = is_alone;
        remark
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "cooperative"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Cooperative::new(*self))
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 0.44e-3, share_of_each_other: 0.02 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }

    fn shared_goal(&self, goal: &Goal) -> Option<Goal> {
        Some(Settings::shared_goal(self, goal))
    }

    fn replacement_in_why(&self) -> Option<StandardReplacement> {
        Some(StandardReplacement::planner(2))
    }
}

impl Drive for Cooperative {
    /// Solves the joint problem and returns the plan of the ego.
    ///
    /// # Errors
    /// [`PlanError`] if neither the joint problem nor the conservative one can be solved.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let scene = &self.settings.prediction.applied_to(scene);
        let cooperators = cooperators(scene, self.settings.shared_goal(&scene.goal));
        let names = cooperators.iter().map(|cooperator| cooperator.agent.name.as_str());
        let own = names.clone().position(|name| name == scene.ego.name).unwrap_or_default();
        let known = names.eq(self.last.iter().map(|(name, _)| name.as_str()));
        if !known {
            self.last.clear();
        }
        let problem = joint_problem(scene, &cooperators);
        let keep: Vec<Vec<Input>> = self.last.iter().map(|(_, trajectory)| trajectory.later_inputs()).collect();
        match self.optimiser.optimise(&problem, &keep) {
            Ok(optimum) => {
                let parts = cooperators.iter().enumerate();
                self.last = parts.map(|(i, part)| (part.agent.name.clone(), optimum.trajectory(i))).collect();
                let answer = self.answer(&problem, &optimum, own);
                let events = self.remark(scene, cooperators.len()).into_iter().collect();
                Ok(Plan { problem: Some(Arc::new(problem)), events, ..answer })
            }
            Err(error) => {
                let last = std::mem::take(&mut self.last);
                let last = last.get(own).map(|(_, trajectory)| trajectory);
                Ok(conservative::answer(conservative::fall_back(&mut self.optimiser, scene, last, &error)?))
            }
        }
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        let optimiser = self.optimiser.clone().searching(settings.passing_orders);
        Some(Box::new(Cooperative { settings, optimiser, ..self.clone() }))
    }
}

impl Cooperative {
    fn answer(&self, problem: &Problem, optimum: &Optimum, own: usize) -> Plan {
        let others = self.last.iter().enumerate().filter(|(index, _)| *index != own).map(|(_, part)| part.clone());
        let proposals = others.map(|(to, trajectory)| Proposal { to, trajectory, acceptance: None }).collect();
        let mut diagnostics: Vec<Diagnostic> = vec![
            COOPERATING_VEHICLES.is(self.last.len() as f64),
            OWN_COST.is(problem.own_cost(own, &optimum.iterate)),
            COST.is(optimum.cost.total),
            SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety)),
        ];
        diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
        diagnostics.extend(Activity::count(problem, &optimum.iterate, own).diagnostics());
        let trajectory = optimum.trajectory(own);
        Plan { trajectory, proposals, diagnostics, statistics: optimum.statistics, ..Plan::default() }
    }
}
