//! Plans that branch (contingency): one motion now, and a continuation for each future.
//!
//! The ego does not know which driver it meets. With futures `i` of probability `p_i`, in each of which the others move as one
//! hypothesis about each of them says, it solves
//!
//! ```text
//! minimise  Σ_i p_i J(u⁽ⁱ⁾)      such that   the ellipses around the others of future i are kept, for every i,
//!                                           u⁽ⁱ⁾_k = u⁽ʲ⁾_k   for k < n
//! ```
//!
//! where `n` is the step at which the futures can be told apart. A plan for the likeliest future alone may count on being let in
//! where it cannot know yet; one that is safe in all futures at once waits for what it will soon know. (Contingency games: Peters
//! et al. 2024. Here the others' motions do not depend on the branch: each hypothesis answers the ego's last plan.)
//!
//! With one future it is the conservative problem (eq. 6.13) with the inferred prediction.

pub mod diagnostics;
mod futures;
mod settings;

use std::sync::Arc;

pub use futures::{Future, futures, shared_steps};
pub use settings::Settings;

use crate::drivers::conservative;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::drivers::receding_horizon;
use crate::plan::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::activity::Activity;
use crate::trajectory::terms::KeepOut;
use crate::trajectory::{Optimiser, Optimum, Penalty, Problem, Robust, Term, Violation};
use crate::{Diagnostic, Goal, Input, Plan, PlanBranch, PlanError, PlanTime, Scene, Trajectory};
use diagnostics::{FUTURES, LIKELIEST, SHARED_STEPS};

/// The contingency planner, whose plan branches into one continuation a future, with its last plan.
#[derive(Clone, Debug)]
pub struct Contingency {
    settings: Settings,
    optimiser: Optimiser<Robust>,
    /// The last motion in each future, with the hypotheses of that future.
    last: Vec<(Vec<usize>, Trajectory)>,
}

/// The trajectory problem of the planning vehicle in several futures: one participant a future, with equal inputs in
/// the first
/// `shared_steps` steps.
pub fn problem(scene: &Scene, futures: &[Future], shared_steps: usize) -> Problem {
    let mut terms = Vec::new();
    for (vehicle, future) in futures.iter().enumerate() {
        let share = |weight: f64| future.probability * weight;
        let Goal { tracking, comfort, .. } = scene.goal;
        let goal = Goal { tracking: tracking.map(share), comfort: comfort.map(share), ..scene.goal };
        terms.extend(scene.own_terms(vehicle, &goal));
        let others = scene.others.iter().zip(&future.predictions).filter(|(other, _)| scene.minds(other));
        terms.extend(others.map(|(other, prediction)| {
            let keep_out = scene.keep_out(prediction, &other.route, Penalty::EXACT);
            Term::KeepOut(KeepOut { vehicle, ..keep_out })
        }));
    }
    Problem { horizon: scene.horizon, participants: vec![scene.participant(); futures.len()], shared_steps, terms }
}

impl Contingency {
    /// A planner that has not planned yet.
    pub fn new(settings: Settings) -> Self {
        Contingency {
            settings,
            optimiser: Optimiser::receding_horizon(Robust::default()).searching(settings.passing_orders),
            last: Vec::new(),
        }
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "contingency"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Contingency::new(*self))
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 0.1e-3, share_of_each_other: 6.0 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(crate::prediction::Prediction::Inferred)
    }

    fn branches(&self) -> bool {
        true
    }
}

impl Drive for Contingency {
    /// Makes a plan with a continuation for each of the likeliest futures.
    ///
    /// # Errors
    /// [`PlanError`] if neither this problem nor the conservative one can be solved.
    fn plan(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError> {
        let futures = futures(scene, &inferred_futures.alternatives, &self.settings);
        let shared_steps = shared_steps(&futures, self.settings.told_apart_m, inferred_futures.delay, scene.horizon);
        let problem = problem(scene, &futures, shared_steps);
        let likeliest = likeliest(&futures);
        match self.optimiser.optimise(&problem, &self.guess(scene, &futures)) {
            Ok(optimum) => {
                let motions = futures.iter().enumerate();
                self.last = motions.map(|(i, of)| (of.hypotheses.clone(), optimum.trajectory(i))).collect();
                Ok(answer(problem, &futures, likeliest, &optimum))
            }
            Err(error) => {
                let last = std::mem::take(&mut self.last);
                let last = last.first().map(|(_, motion)| motion);
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
        Some(Box::new(Contingency { settings, optimiser, ..self.clone() }))
    }
}

impl Contingency {
    /// The last motion in each future, a step later; in a new one, that of the first.
    fn guess(&self, scene: &Scene, futures: &[Future]) -> Vec<Vec<Input>> {
        let guess = futures.iter().map(|future| {
            let same = self.last.iter().find(|(hypotheses, _)| *hypotheses == future.hypotheses);
            receding_horizon::guess(scene, same.or(self.last.first()).map(|(_, motion)| motion))
        });
        guess.collect()
    }
}

/// The number of the likeliest future.
fn likeliest(futures: &[Future]) -> usize {
    let by_probability = |a: &usize, b: &usize| futures[*a].probability.total_cmp(&futures[*b].probability);
    (0..futures.len()).rev().max_by(by_probability).unwrap_or_default()
}

fn answer(problem: Problem, futures: &[Future], likeliest: usize, optimum: &Optimum) -> Plan {
    let mut diagnostics: Vec<Diagnostic> = vec![
        FUTURES.is(futures.len() as f64),
        LIKELIEST.is(futures[likeliest].probability),
        SHARED_STEPS.is(problem.shared_steps as f64),
        COST.is(optimum.cost.total),
        SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety)),
    ];
    diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
    diagnostics.extend(Activity::count(&problem, &optimum.iterate, likeliest).diagnostics());
    let other = (0..futures.len()).filter(|future| *future != likeliest);
    let branches = other
        .map(|future| PlanBranch { probability: futures[future].probability, trajectory: optimum.trajectory(future) });
    Plan {
        trajectory: optimum.trajectory(likeliest),
        branches: branches.collect(),
        diagnostics,
        problem: Some(Arc::new(problem)),
        statistics: optimum.statistics,
        ..Plan::default()
    }
}
