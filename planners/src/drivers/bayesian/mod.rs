//! Bayesian persuasion (chapter 7): the ego's motion is a signal about how conservative it is.
//!
//! The other's impression of the ego is the elliptical distance `ω = ‖I′(x_sᴾ − x_e)‖` (eq. 7.2, 7.7): a vehicle that comes close seems
//! bold. At every step the planner
//!
//! 1. chooses whom to persuade, one vehicle after the other;
//! 2. reads from the change of the other's plan how loyal it is to it (`belief`, eq. 7.28), or from what it believes of the
//!    other's driver where it infers plans, and from the change of its own plan how clear its signal is (eq. 7.27);
//! 3. prices impressions by what the other's best response to them is worth (`value`, eq. 7.18, 7.19);
//! 4. solves for its own trajectory only (`signal`, eq. 7.23-7.26).
//!
//! The safety ellipse around the other's plan is a soft constraint with an exact penalty, as for the conservative planner.
//! Persuasion enters the cost only.

mod belief;
pub mod diagnostics;
mod settings;
mod signal;
mod value;

use std::sync::Arc;

pub use belief::PersuasionBelief;
pub use settings::{ReplyValue, Settings};
pub use signal::problem;
pub use value::attraction;

use serde_json::{Map, Value as Json, json};

use crate::drivers::conservative;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::drivers::partner_choice::{PartnerChoice, PartnerSequence};
use crate::drivers::receding_horizon::Solved;
use crate::plan::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::activity::Activity;
use crate::trajectory::{Optimiser, Optimum, Problem, Robust, Term, Violation};
use crate::{Diagnostic, Plan, PlanError, PlanTime, Scene, Trajectory};
use diagnostics::{ATTRACTION, BELIEF_VARIANCE, CONSERVATIVENESS, LOYALTY, OTHER_CHANGE, OWN_CHANGE};

/// The planner of Bayesian persuasion (chapter 7) with its beliefs and its last plan.
#[derive(Clone, Debug)]
pub struct Bayesian {
    settings: Settings,
    optimiser: Optimiser<Robust>,
    partner: PartnerSequence,
    belief: PersuasionBelief,
    /// The partner's plan of one step before.
    partner_plan: Option<Trajectory>,
    last: Option<Trajectory>,
}

impl Bayesian {
    /// A planner that has not interacted with any vehicle yet.
    pub fn new(settings: Settings) -> Self {
        Bayesian {
            settings,
            optimiser: Optimiser::receding_horizon(Robust::default()).searching(settings.passing_orders),
            partner: PartnerSequence::default(),
            belief: PersuasionBelief::initial(&settings),
            partner_plan: None,
            last: None,
        }
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "bayesian"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Bayesian::new(*self))
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 0.32e-3, share_of_each_other: 0.05 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }

    /// Checks that the range of `w_1` is not empty and lies above `w_4`.
    fn check(&self, _: usize) -> Result<(), crate::DriverSettingError> {
        let ordered = |key, lower: f64, upper_key, upper: f64| match lower <= upper {
            true => Ok(()),
            false => Err(crate::DriverSettingError::BoundsCrossed { key, lower, upper_key, upper }),
        };
        ordered("w_1_min", self.w_1_min, "w_1_max", self.w_1_max)?;
        ordered("w_4", self.w_4, "w_1_min", self.w_1_min)
    }

    fn people_defaults(&self) -> Map<String, Json> {
        Map::from_iter([("answer_s".to_owned(), json!(0.9))])
    }

    fn rank_beside_person(&self) -> Option<u8> {
        Some(2)
    }
}

impl Drive for Bayesian {
    /// Makes a plan for the scene: chooses a partner, updates the beliefs about it, and solves the trajectory problem.
    ///
    /// # Errors
    /// [`PlanError`] if not even the conservative problem can be solved.
    fn plan(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError> {
        let scene = &self.settings.prediction.applied_to(scene);
        let choice = self.partner.choose(scene, self.settings.clear_lead_m);
        self.observe(&choice, scene.step_s, inferred_futures);
        let problem = problem(scene, choice.partner, self.last.as_ref(), &self.belief, &self.settings);
        let Solved { problem, optimum, event } =
            conservative::solve_or_fall_back(&mut self.optimiser, scene, problem, self.last.as_ref())?;
        let diagnostics = self.diagnostics(&problem, &optimum);
        let trajectory = optimum.trajectory(0);
        if let Some(before) = &self.last {
            self.belief.observe_own_plan(&trajectory, before, &scene.ego.body, &self.settings);
        }
        self.last = Some(trajectory.clone());
        let events = choice.event("persuades", "to persuade").into_iter().chain(event).collect();
        let (problem, statistics) = (Some(Arc::new(problem)), optimum.statistics);
        Ok(Plan { trajectory, diagnostics, events, problem, statistics, ..Plan::default() })
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        let optimiser = self.optimiser.clone().searching(settings.passing_orders);
        Some(Box::new(Bayesian { settings, optimiser, ..self.clone() }))
    }
}

impl Bayesian {
    /// Updates the belief about the vehicle to persuade.
    fn observe(&mut self, choice: &PartnerChoice, step_s: f64, inferred_futures: &InferredFutures) {
        if choice.is_new {
            self.belief = PersuasionBelief::initial(&self.settings);
            self.partner_plan = None;
        }
        let before = self.partner_plan.as_ref().filter(|_| choice.may_have_answered(self.settings.answer_s, step_s));
        if let (Some(partner), Some(before)) = (choice.partner, before) {
            let estimate = inferred_futures.estimate(&partner.name);
            self.belief.observe(partner, before, estimate, &self.settings);
        }
        self.partner_plan = choice.partner.map(|partner| (*partner.prediction).clone());
    }

    fn diagnostics(&self, problem: &Problem, optimum: &Optimum) -> Vec<Diagnostic> {
        let PersuasionBelief { alpha, beta_m, variance, w_1, .. } = self.belief;
        let mut diagnostics = Vec::new();
        for term in &problem.terms {
            let Term::DistanceCost(impression) = term else { continue };
            let states = optimum.iterate.states[0].iter().skip(1).enumerate();
            let nearest = states.map(|(k, state)| impression.omega(k, state.position())).fold(f64::INFINITY, f64::min);
            diagnostics.extend([
                CONSERVATIVENESS.is(nearest),
                BELIEF_VARIANCE.is(variance),
                LOYALTY.is(w_1),
                ATTRACTION.is(attraction(w_1, self.settings.w_4)),
                OWN_CHANGE.is(alpha),
                OTHER_CHANGE.is(beta_m),
            ]);
        }
        diagnostics.extend([COST.is(optimum.cost.total), SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety))]);
        diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
        diagnostics.extend(Activity::count(problem, &optimum.iterate, 0).diagnostics());
        diagnostics
    }
}
