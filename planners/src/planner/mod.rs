//! A driver with its surroundings, which are the same for every kind of driver: inference, certificate and deadline.

use std::borrow::Cow;

use crate::drivers::Driver;
use crate::drivers::drive::{Drive, DriverKind};
use crate::drivers::reaction::Reaction;
use crate::perception::belief::{self, DriverBeliefs};
use crate::perception::sensing::SensedScene;
use crate::plan::certificate::{refused, refused_by_motion, violations, within_touch};
use crate::plan::homotopy::HomotopyLog;
use crate::prediction::Prediction;
use crate::rules::urgency::emergency_braking_mps2;
use crate::scene::Moment;
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::Statistics;
use crate::{Plan, PlanError, PlanViolation, Scene};

/// A driver in operation: it infers the plans that the driver does not know, checks each plan and its deadline, and
/// logs homotopy classes.
///
/// It is the same for all kinds of drivers, and knows them only through [`DriverKind`] and [`Drive`].
#[derive(Debug)]
pub struct Planner {
    driver: Box<dyn Drive>,
    /// What it believes of the others, if it is not told their plans.
    beliefs: Option<Box<DriverBeliefs>>,
    /// Whether the driver is given what each of the others may do.
    branches: bool,
    homotopy_log: HomotopyLog,
    /// What its certificates take for where the others will be.
    prediction: Prediction,
    /// Whether a plan may be refused of a driver who knows plans. Those who go first are what the others have to live with, and drive as they
    /// do.
    may_be_refused: bool,
    /// Whether a plan may be refused of a driver who sees the motion of the others only.
    is_vetoed: bool,
    /// Whether the driver reacts and plans nothing ahead.
    reacts: bool,
    /// When a plan is too late; never by default.
    deadline: Option<PlanDeadline>,
}

impl Driver {
    /// A planner with this driver that has not planned yet. If it infers plans, it does so with the default settings.
    pub fn planner(&self) -> Planner {
        self.planner_believing(&belief::Settings::default())
    }

    /// As [`Driver::planner`], with settings for the inference of plans.
    pub fn planner_believing(&self, inference: &belief::Settings) -> Planner {
        Planner::new(&**self, inference)
    }
}

impl Planner {
    /// A planner with a driver of this kind that has not planned yet. `inference` sets how it infers plans that it does not know.
    pub fn new(kind: &dyn DriverKind, inference: &belief::Settings) -> Self {
        Planner {
            driver: kind.driver(),
            beliefs: (!kind.knows_plans()).then(|| Box::new(DriverBeliefs::new(*inference))),
            branches: kind.branches(),
            homotopy_log: HomotopyLog::default(),
            prediction: kind.prediction().unwrap_or_default(),
            may_be_refused: kind.may_be_refused(),
            is_vetoed: kind.is_vetoed(),
            reacts: kind.reacts(),
            deadline: None,
        }
    }

    /// The same planner with this deadline for its plans, or with none.
    pub fn with_deadline(self, deadline: Option<PlanDeadline>) -> Self {
        Planner { deadline, ..self }
    }

    /// Replaces the driver. Properties of the former driver's kind remain: what the driver knows, and whether its plans may be refused.
    pub fn replace_driver(&mut self, driver: Box<dyn Drive>) {
        (self.driver, self.reacts) = (driver, false);
    }

    /// Changes the settings of the driver, or its kind. A driver of the same kind keeps its memory, one of another kind
    /// starts anew; beliefs are kept in both cases. `inference` sets how the planner infers plans from now on.
    pub fn change(&mut self, kind: &dyn DriverKind, inference: &belief::Settings) {
        let beliefs = self.beliefs.take().or_else(|| Some(Box::new(DriverBeliefs::new(*inference))));
        self.driver = self.driver.with_settings(kind).unwrap_or_else(|| kind.driver());
        self.beliefs = beliefs.filter(|_| !kind.knows_plans());
        self.branches = kind.branches();
        self.prediction = kind.prediction().unwrap_or_default();
        self.may_be_refused = kind.may_be_refused();
        self.is_vetoed = kind.is_vetoed();
        self.reacts = kind.reacts();
    }

    /// A copy with the same memory; `None` if the driver cannot be copied.
    pub fn fork(&self) -> Option<Self> {
        Some(Planner {
            driver: self.driver.fork()?,
            beliefs: self.beliefs.clone(),
            homotopy_log: self.homotopy_log.clone(),
            ..*self
        })
    }

    /// Plans the next move in a scene that shows all vehicles as they are. Vehicles that cannot meet this one within
    /// the horizon are left out.
    ///
    /// # Errors
    /// [`PlanError`] if no plan was found; the caller falls back.
    pub fn plan(&mut self, scene: &Scene) -> Result<Plan, PlanError> {
        let near = scene.within_reach();
        match self.beliefs {
            Some(_) => self.plan_sensed(&SensedScene::perfect(&near)),
            None => self.plan_as_told(&near, &InferredFutures::default()),
        }
    }

    /// Whether the driver reacts and plans nothing ahead.
    pub fn reacts(&self) -> bool {
        self.reacts
    }

    /// Asks a driver that reacts for its input at a moment. In place of the veto of a plan, it brakes in an emergency as hard as it needs.
    ///
    /// # Errors
    /// [`PlanError`] if a driver that answers with plans only found none.
    pub fn react(&mut self, moment: &Moment<'_>) -> Result<Reaction, PlanError> {
        let mut reaction = match self.driver.react(moment) {
            Some(reaction) => reaction,
            None => Reaction::of(self.driver.plan(&moment.scene(), &InferredFutures::default())?),
        };
        if let Some(braking_mps2) = emergency_braking_mps2(moment.own).filter(|_| self.is_vetoed) {
            let wanted_mps2 = &mut reaction.input.acceleration_mps2;
            *wanted_mps2 = wanted_mps2.min(-braking_mps2);
        }
        Ok(reaction)
    }

    /// Plans the next move in a sensed scene, with inferred predictions where the driver knows no plans.
    ///
    /// # Errors
    /// As [`Planner::plan`].
    pub fn plan_sensed(&mut self, sensed: &SensedScene) -> Result<Plan, PlanError> {
        let Some(beliefs) = &mut self.beliefs else {
            return self.plan_as_told(&sensed.scene, &InferredFutures::default());
        };
        let inferred = beliefs.infer(sensed);
        let inferred_futures = InferredFutures {
            alternatives: if self.branches { beliefs.alternatives(sensed, &inferred.scene) } else { Vec::new() },
            estimates: inferred.estimates,
            delay: sensed.oldest_sighting(),
        };
        let mut plan = self.plan_as_told(&inferred.scene, &inferred_futures)?;
        plan.diagnostics.extend(inferred.diagnostics);
        plan.events.splice(0..0, inferred.events);
        plan.beliefs = inferred_futures.estimates;
        Ok(plan)
    }

    /// The scene as the driver expects it, with those at least whom the plan touches in it.
    fn expected_to_touch<'a>(&self, scene: &'a Scene, plan: &Plan) -> Cow<'a, Scene> {
        if self.prediction != Prediction::ConstantVelocity || scene.knowledge.is_of_motion() {
            return Cow::Borrowed(scene);
        }
        let others = within_touch(scene, &plan.trajectory);
        Cow::Owned(self.prediction.applied_to(&Scene { others, ego: scene.ego.clone(), ..*scene }).into_owned())
    }

    /// Plans the next move with the predictions of the scene, and says of a plan with a problem how it passes the others.
    fn plan_as_told(&mut self, scene: &Scene, inferred_futures: &InferredFutures) -> Result<Plan, PlanError> {
        let mut plan = self.driver.plan(scene, inferred_futures)?;
        self.deadline.map_or(Ok(()), |deadline| deadline.check(&plan.statistics))?;
        plan.violations = violations(&self.expected_to_touch(scene, &plan), &plan.trajectory);
        if let Some(violation) = self.refused(scene, &plan) {
            return Err(PlanError::Refused(violation));
        }
        if plan.problem.is_some() {
            self.homotopy_log.note(scene, &mut plan);
        }
        Ok(plan)
    }

    /// The violation for which a plan is refused.
    fn refused(&self, scene: &Scene, plan: &Plan) -> Option<PlanViolation> {
        let Plan { trajectory, violations, .. } = plan;
        if scene.knowledge.is_of_motion() {
            return self.is_vetoed.then(|| refused_by_motion(scene, trajectory, violations)).flatten();
        }
        let may_be_refused = self.may_be_refused && !violations.is_empty();
        let refused = may_be_refused.then(|| refused(&self.prediction.applied_to(scene), trajectory, violations));
        refused.flatten().cloned()
    }
}

/// The most work that a plan may take. A plan that took more is discarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanDeadline {
    most_work: usize,
}

impl PlanDeadline {
    /// Units of [work](Statistics::work) that a millisecond stands for. A unit took 10 to 35 µs for the planners and machine of
    /// `docs/evidence/benchmarks.md`.
    const WORK_PER_MS: f64 = 50.0;

    /// The deadline after this time \[ms\], converted to the work that the reference machine does in it; at least one unit of work.
    pub fn after_ms(budget_ms: f64) -> Self {
        PlanDeadline { most_work: (budget_ms * PlanDeadline::WORK_PER_MS).round().max(1.0) as usize }
    }

    /// Checks that the work behind a plan stayed within the deadline.
    ///
    /// # Errors
    /// [`PlanError::Late`] if it did not.
    pub fn check(self, done: &Statistics) -> Result<(), PlanError> {
        let (work, most_work) = (done.work(), self.most_work);
        if work <= most_work { Ok(()) } else { Err(PlanError::Late { work, most_work }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_is_late_if_it_takes_more_work_than_its_deadline() {
        let done = |work| Statistics { inner_iterations: work, ..Statistics::default() };
        let deadline = PlanDeadline::after_ms(2.0);
        assert_eq!(deadline.check(&done(100)), Ok(()));
        assert_eq!(deadline.check(&done(101)), Err(PlanError::Late { work: 101, most_work: 100 }));
        assert_eq!(PlanDeadline::after_ms(1e-9).check(&done(1)), Ok(()));
    }
}
