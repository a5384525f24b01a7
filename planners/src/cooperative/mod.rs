//! Cooperation (section 6.2): one problem for all vehicles that share it.
//!
//! ```text
//! minimise  Σ_i 1/Z_i Σ_t (‖x_i − x_i,des‖²_Q + ‖Δu_i‖²_R)        (6.6)
//! such that everybody obeys the bicycle, its bounds and its road, and all keep apart    (6.7-6.11)
//! ```
//!
//! Its solutions are Pareto optimal: with positive weights `1/Z_i`, nobody can be served better without somebody being served
//! worse. The source's two vehicles are one case of any number.
//!
//! Nobody is in charge. Every vehicle with this driver tells the others what it wants ([`Agent::shared_goal`]), solves the
//! same problem in the same way, and drives its own part of the solution. As everything is deterministic and the vehicles
//! are ordered by name, all solutions are the same, bit for bit, as long as all know the same.
//!
//! Who goes first is decided by the starting guess, so at the first step every order of "one accelerates, the others brake"
//! is tried.

pub mod diagnostics;
mod problem;
mod settings;

pub use problem::{Cooperator, cooperators, problem};
pub use settings::Settings;

use crate::conservative;
use crate::diagnostic::{COST, SAFETY_SLACK};
use crate::predict::steady;
use crate::trajectory::activity::Activity;
use crate::trajectory::{Optimiser, Optimum, Problem, Robust, Violation};
use crate::{Agent, Diagnostic, Goal, Input, Plan, PlanError, Proposal, Scene, Trajectory};
use diagnostics::{COOPERATING_VEHICLES, OWN_COST};

/// A cooperating planner with the joint plan it made last.
#[derive(Clone, Debug)]
pub struct Cooperative {
    settings: Settings,
    optimiser: Optimiser<Robust>,
    /// Everybody's name and part.
    last: Vec<(String, Trajectory)>,
}

impl Settings {
    /// What a vehicle with these settings tells the others: its goal, weighted with `1/Z_i`.
    pub fn shared_goal(&self, goal: &Goal) -> Goal {
        let share = 1.0 / self.normaliser;
        let (tracking, comfort) = (goal.tracking.map(|q| share * q), goal.comfort.map(|r| share * r));
        Goal { tracking, comfort, ..*goal }
    }
}

impl Cooperative {
    /// A planner that has not planned yet.
    pub fn new(settings: Settings) -> Self {
        Cooperative { settings, optimiser: Optimiser::resuming(Robust::default()), last: Vec::new() }
    }

    /// Plans everybody's moves and answers with the own ones.
    ///
    /// # Errors
    /// [`PlanError`] if neither the joint problem nor the conservative one can be solved.
    pub fn plan(&mut self, scene: &Scene) -> Result<Plan, PlanError> {
        let scene = &self.settings.prediction.applied_to(scene);
        let cooperators = cooperators(scene, self.settings.shared_goal(&scene.goal));
        let names = cooperators.iter().map(|cooperator| cooperator.agent.name.as_str());
        let own = names.clone().position(|name| name == scene.ego.name).unwrap_or_default();
        let known = names.eq(self.last.iter().map(|(name, _)| name.as_str()));
        if !known {
            self.last.clear();
        }
        let problem = problem(scene, &cooperators);
        let every = self.settings.look_around_every;
        let look_around = !known || (every > 0 && scene.tick.is_multiple_of(every));
        match self.optimiser.best_of(&problem, &self.guesses(scene, &cooperators), look_around) {
            Ok(optimum) => {
                let parts = cooperators.iter().enumerate();
                self.last = parts.map(|(i, part)| (part.agent.name.clone(), optimum.trajectory(i))).collect();
                Ok(self.answer(&problem, &optimum, own))
            }
            Err(error) => {
                let last = std::mem::take(&mut self.last);
                let last = last.get(own).map(|(_, trajectory)| trajectory);
                Ok(conservative::answer(&conservative::retreat(&mut self.optimiser, scene, last, &error)?))
            }
        }
    }

    /// The last plan one step later, then everybody in turn going first.
    fn guesses(&self, scene: &Scene, cooperators: &[Cooperator]) -> Vec<Vec<Vec<Input>>> {
        let keep = self.last.iter().map(|(_, trajectory)| trajectory.later_inputs()).collect();
        let firmly = |agent: &Agent, first: bool| {
            let limits = &agent.limits;
            let bound = if first { limits.acceleration_max_mps2 } else { limits.acceleration_min_mps2 };
            steady(&agent.state, bound, limits, scene.horizon, scene.step_s)
        };
        let orders = (0..cooperators.len()).map(|first| {
            let everybody = cooperators.iter().enumerate();
            everybody.map(|(i, cooperator)| firmly(&cooperator.agent, i == first)).collect()
        });
        std::iter::once(keep).chain(orders).collect()
    }

    fn answer(&self, problem: &Problem, optimum: &Optimum, own: usize) -> Plan {
        let mut others = self.last.iter().enumerate().filter(|(index, _)| *index != own).map(|(_, part)| part.clone());
        let proposal = match (others.next(), others.next()) {
            (Some((to, trajectory)), None) => Some(Proposal { to, trajectory, acceptance: None }),
            _ => None,
        };
        let mut diagnostics: Vec<Diagnostic> = vec![
            COOPERATING_VEHICLES.is(self.last.len() as f64),
            OWN_COST.is(problem.own_cost(own, &optimum.iterate)),
            COST.is(optimum.cost.total),
            SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety)),
        ];
        diagnostics.extend(Activity::of(problem, &optimum.iterate, own).diagnostics());
        let trajectory = optimum.trajectory(own);
        Plan { trajectory, proposal, diagnostics, events: Vec::new(), statistics: optimum.statistics }
    }
}
