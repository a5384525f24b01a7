//! The conservative baseline (eq. 6.13): the ego keeps out of the safety ellipses around the others' predicted positions.
//!
//! The predictions are fixed. The ego assumes that no vehicle reacts to it, whichever has the right of way. Each ellipse is a soft
//! constraint with an exact penalty ([`Penalty::EXACT`](crate::trajectory::Penalty::EXACT)), so it holds wherever it can.

pub mod diagnostics;
mod fallback;
mod settings;

pub(crate) use fallback::{fall_back, solve_or_fall_back};
use std::sync::Arc;

pub use settings::Settings;

use crate::drivers::drive::StandardReplacement;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::drivers::receding_horizon::{self, Solved};
use crate::plan::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::activity::Activity;
use crate::trajectory::{DescentError, HomotopySearch, Optimiser, Problem, Robust, Violation};
use crate::{Agent, Diagnostic, Plan, PlanError, PlanTime, Scene, Trajectory};

/// The conservative planner (eq. 6.13) with its last plan.
#[derive(Clone, Debug)]
pub struct Conservative {
    settings: Settings,
    optimiser: Optimiser<Robust>,
    last: Option<Trajectory>,
}

/// The conservative problem (eq. 6.13) of the planning vehicle: it keeps out of the safety ellipses around the
/// predictions of
/// `others`.
pub fn problem(scene: &Scene, others: &[&Agent]) -> Problem {
    let mut terms = scene.own_terms(0, &scene.goal);
    terms.extend(scene.exact_keep_outs(others.iter().copied()));
    Problem { horizon: scene.horizon, participants: vec![scene.participant()], shared_steps: 0, terms }
}

impl Conservative {
    /// A planner that has not planned yet.
    pub fn new(settings: Settings) -> Self {
        Conservative {
            settings,
            optimiser: Optimiser::receding_horizon(Robust::default()).searching(settings.passing_orders),
            last: None,
        }
    }

    /// The same, which compares other classes of motion.
    pub(crate) fn searching(&self, passing_orders: HomotopySearch) -> Self {
        let settings = Settings { passing_orders, ..self.settings };
        Conservative { settings, optimiser: self.optimiser.clone().searching(passing_orders), ..self.clone() }
    }

    /// The same with a limit of the work of a descent, beyond which it hands out what it has come to.
    pub(crate) fn limited_to(mut self, work_limit: usize) -> Self {
        self.optimiser.tolerances.work_limit = work_limit;
        self
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "conservative"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Conservative::new(*self))
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 0.47e-3, share_of_each_other: 0.02 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }

    fn replacement_in_why(&self) -> Option<StandardReplacement> {
        Some(StandardReplacement::planner(1))
    }

    fn rank_beside_person(&self) -> Option<u8> {
        Some(1)
    }
}

impl Drive for Conservative {
    /// Makes a plan that keeps out of the safety ellipses around the predictions of all other vehicles.
    ///
    /// # Errors
    /// [`PlanError`] if no starting guess leads to an optimum.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        Ok(answer(self.optimise(scene)?))
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        let optimiser = self.optimiser.clone().searching(settings.passing_orders);
        Some(Box::new(Conservative { settings, optimiser, ..self.clone() }))
    }
}

impl Conservative {
    /// As [`Conservative::plan`], but returns the optimum together with the problem that it solves.
    pub(crate) fn optimise(&mut self, scene: &Scene) -> Result<Solved, DescentError> {
        let scene = &self.settings.prediction.applied_to(scene);
        let others: Vec<&Agent> = scene.others.iter().collect();
        let problem = problem(scene, &others);
        let guess = receding_horizon::guess(scene, self.last.as_ref());
        let solved = receding_horizon::solve_or_improve(&mut self.optimiser, problem, guess)?;
        self.last = Some(solved.optimum.trajectory(0));
        Ok(solved)
    }
}

/// Turns a solved problem into a plan. Its diagnostics are the cost, the violation of safety, and the active constraints.
pub(crate) fn answer(Solved { problem, optimum, event }: Solved) -> Plan {
    let cost = &optimum.cost;
    let mut diagnostics: Vec<Diagnostic> =
        vec![COST.is(cost.total), SAFETY_SLACK.is(cost.violation(Violation::Safety))];
    diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
    diagnostics.extend(Activity::count(&problem, &optimum.iterate, 0).diagnostics());
    Plan {
        trajectory: optimum.trajectory(0),
        diagnostics,
        events: event.into_iter().collect(),
        problem: Some(Arc::new(problem)),
        statistics: optimum.statistics,
        ..Plan::default()
    }
}
