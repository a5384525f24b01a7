//! A general-sum game of the vehicles that meet: the ego follows its part of a generalised Nash equilibrium.
//!
//! Each of 2 to 4 players minimises the cost of its own motion (eq. 6.6) and shares with every other the constraint that their safety
//! ellipses are not entered. `equilibrium.rs` says how an equilibrium is found and certified. What the others want is not known:
//! the ego supposes that they want to stay where their predicted motions lead, at the highest speed at which it saw them.
//! Vehicles that do not play are obstacles on their predicted ways.

mod best_responses;
mod deviation;
pub mod diagnostics;
mod equilibrium;
mod players;
mod prioritised;
mod refusals;
mod settings;

use std::sync::Arc;

pub use deviation::TOLERATED_GAIN;
pub use equilibrium::{Equilibrium, equilibrium};
pub use settings::Settings;

use crate::drivers::conservative;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::drivers::receding_horizon;
use crate::plan::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::problem::{JointVehicle, joint_problem};
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::HomotopySearch;
use crate::trajectory::activity::Activity;
use crate::trajectory::{Optimiser, Problem, Robust, Violation};
use crate::{Diagnostic, Input, Plan, PlanError, PlanEvent, PlanTime, Proposal, Scene, Trajectory};
use diagnostics::{DEVIATION_GAIN, EGO_COST, PLAYERS};
use players::{SeenSpeeds, players};
use refusals::Refusals;

/// The planner of the general-sum game with its last equilibrium.
#[derive(Clone, Debug)]
pub struct Nash {
    settings: Settings,
    joint: Optimiser<Robust>,
    responses: Optimiser<Robust>,
    seen: SeenSpeeds,
    refusals: Refusals,
    /// The last trajectory of each player, with its name; the ego is the first.
    last: Vec<(String, Trajectory)>,
}

/// Most [work](crate::trajectory::Statistics::work) of a descent of the joint problem. One that takes more creeps past a saddle, and
/// best responses settle sooner.
const JOINT_WORK_LIMIT: usize = 500;
/// A full step of a descent of the joint problem is compared with the worst of this many iterates and the last one: where two vehicles
/// both turn along an ellipse, steps that enter it a little and leave it with the next one lead on much faster than those that stay
/// outside.
const REMEMBERED_COSTS: usize = 7;

/// An optimiser for the joint problem of a game, whose optima are candidates for equilibria.
pub fn joint_optimiser(search: HomotopySearch) -> Optimiser<Robust> {
    let mut joint = Optimiser::receding_horizon(Robust::default()).searching(search);
    joint.tolerances.work_limit = JOINT_WORK_LIMIT;
    joint.tolerances.remembered_costs = REMEMBERED_COSTS;
    joint
}

impl Nash {
    /// A planner that has not seen any vehicle yet.
    pub fn new(settings: Settings) -> Self {
        Nash {
            settings,
            joint: joint_optimiser(settings.passing_orders),
            // The comparison of the joint problem looks into the other homotopy classes.
            responses: Optimiser::new(Robust::default()).searching(HomotopySearch::Off),
            seen: SeenSpeeds::default(),
            refusals: Refusals::default(),
            last: Vec::new(),
        }
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "nash"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Nash::new(*self))
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 1.4e-3, share_of_each_other: 0.34 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }
}

impl Drive for Nash {
    /// Finds an equilibrium and returns the ego's part of it.
    ///
    /// # Errors
    /// [`PlanError`] if neither the game nor the conservative problem can be solved.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let scene = &self.settings.prediction.applied_to(scene);
        self.seen.look(scene);
        self.refusals.look(scene, &self.last, self.settings.patience_steps);
        let plays = |name: &str| self.refusals.plays(name, self.settings.patience_steps);
        let players = players(scene, &self.seen, &self.settings, plays);
        let problem = joint_problem(scene, &players);
        let guess = self.guess(scene, &players);
        match equilibrium(&mut self.joint, &mut self.responses, &problem, &guess) {
            Ok(equilibrium) => {
                let named = players.iter().enumerate();
                self.last =
                    named.map(|(i, part)| (part.agent.name.clone(), equilibrium.optimum.trajectory(i))).collect();
                Ok(self.answer(problem, &equilibrium))
            }
            Err(error) => {
                let last = std::mem::take(&mut self.last);
                let last = last.first().map(|(_, trajectory)| trajectory);
                Ok(conservative::answer(conservative::fall_back(&mut self.joint, scene, last, &error)?))
            }
        }
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        let joint = self.joint.clone().searching(settings.passing_orders);
        Some(Box::new(Nash { settings, joint, ..self.clone() }))
    }
}

impl Nash {
    /// The last motion of each player one step later; of one that did not play, its prediction.
    fn guess(&self, scene: &Scene, players: &[JointVehicle]) -> Vec<Vec<Input>> {
        let guess = players.iter().map(|player| {
            let last = self.last.iter().find(|(name, _)| *name == player.agent.name);
            match last {
                Some((name, motion)) if *name == scene.ego.name => receding_horizon::guess(scene, Some(motion)),
                Some((_, motion)) => motion.later_inputs(),
                None => player.agent.prediction.inputs.clone(),
            }
        });
        guess.collect()
    }

    fn answer(&self, problem: Problem, equilibrium: &Equilibrium) -> Plan {
        let Equilibrium { optimum, .. } = equilibrium;
        let others = self.last.iter().skip(1).cloned();
        let proposals = others.map(|(to, trajectory)| Proposal { to, trajectory, acceptance: None }).collect();
        let mut diagnostics: Vec<Diagnostic> = vec![
            PLAYERS.is(self.last.len() as f64),
            DEVIATION_GAIN.is(equilibrium.largest_gain()),
            EGO_COST.is(problem.own_cost(0, &optimum.iterate)),
            COST.is(optimum.cost.total),
            SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety)),
        ];
        diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
        diagnostics.extend(Activity::count(&problem, &optimum.iterate, 0).diagnostics());
        let gain = equilibrium.largest_gain();
        let event = (!equilibrium.is_certified())
            .then(|| PlanEvent::note(format!("finds no equilibrium: a player gains {gain:.1e} by leaving")));
        Plan {
            trajectory: optimum.trajectory(0),
            proposals,
            diagnostics,
            events: event.into_iter().collect(),
            problem: Some(Arc::new(problem)),
            statistics: optimum.statistics,
            ..Plan::default()
        }
    }
}
