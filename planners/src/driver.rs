//! Every driver a vehicle may have, by the word that a scenario file uses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::bayesian::{self, Bayesian};
use crate::belief::{self, DriverBeliefs, Outlook};
use crate::certificate::{refused, violations};
use crate::conservative::{self, Conservative};
use crate::contingency::{self, Contingency};
use crate::cooperative::{self, Cooperative};
use crate::deadline::PlanDeadline;
use crate::diagnostic::Explanation;
use crate::game::{self, Game};
use crate::human::{self, Human};
use crate::idm::{self, Idm};
use crate::nash::{self, Nash};
use crate::negotiation::{self, Negotiation};
use crate::passing::PassingOrderLog;
use crate::predict::Prediction;
use crate::scripted::{self, Scripted};
use crate::sensing::SensedScene;
use crate::{DriverSettingError, Goal, Plan, PlanError, Scene};

/// The driver of a vehicle with its settings; `kind` in a scenario file chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Driver {
    /// A human: model-predictive control with a safety weight, from tough to nice.
    Human(human::Settings),
    /// The intelligent driver model with MOBIL: the field's baseline of a human.
    Idm(idm::Settings),
    /// Does what the scenario says.
    Scripted(scripted::Settings),
    /// Baseline: keeps out of the safety ellipses around the others' plans (eq. 6.13).
    Conservative(conservative::Settings),
    /// Negotiation with concession and persuasion (chapter 6).
    Negotiation(negotiation::Settings),
    /// Bayesian persuasion (chapter 7).
    Bayesian(bayesian::Settings),
    /// The persuasion game (chapter 8).
    Game(game::Settings),
    /// Cooperation: one problem for all vehicles that have this driver (eq. 6.12).
    Cooperative(cooperative::Settings),
    /// A general-sum game of up to four vehicles: the ego's part of a generalised Nash equilibrium.
    Nash(nash::Settings),
    /// Plans that branch: one continuation for each kind of driver that another may be.
    Contingency(contingency::Settings),
}

/// A driver at work: its settings and all that it remembers.
#[derive(Clone, Debug)]
pub struct Planner {
    method: Method,
    /// What it believes of the others, if it is not told their plans.
    beliefs: Option<Box<DriverBeliefs>>,
    passing_orders: PassingOrderLog,
    /// What its certificates take for where the others will be.
    prediction: Prediction,
    /// Whether a plan may be refused. Those who go first are what the others have to live with, and drive as they do.
    may_be_refused: bool,
    /// When a plan is too late; never by default.
    deadline: Option<PlanDeadline>,
}

/// How a planner finds its plans.
#[derive(Clone, Debug)]
enum Method {
    Human(Human),
    Idm(Idm),
    Scripted(Scripted),
    Conservative(Conservative),
    Negotiation(Box<Negotiation>),
    Bayesian(Box<Bayesian>),
    Game(Box<Game>),
    Cooperative(Box<Cooperative>),
    Nash(Box<Nash>),
    Contingency(Box<Contingency>),
}

impl Driver {
    /// A planner of this kind that has not planned yet; where it infers plans, with the default settings.
    pub fn planner(&self) -> Planner {
        self.planner_believing(&belief::Settings::default())
    }

    /// The same with settings for how it infers plans.
    pub fn planner_believing(&self, inference: &belief::Settings) -> Planner {
        let method = match self {
            Driver::Human(settings) => Method::Human(Human::new(*settings)),
            Driver::Idm(settings) => Method::Idm(Idm::new(*settings)),
            Driver::Scripted(settings) => Method::Scripted(Scripted::new(settings.clone())),
            Driver::Conservative(settings) => Method::Conservative(Conservative::new(*settings)),
            Driver::Negotiation(settings) => Method::Negotiation(Box::new(Negotiation::new(*settings))),
            Driver::Bayesian(settings) => Method::Bayesian(Box::new(Bayesian::new(*settings))),
            Driver::Game(settings) => Method::Game(Box::new(Game::new(*settings))),
            Driver::Cooperative(settings) => Method::Cooperative(Box::new(Cooperative::new(*settings))),
            Driver::Nash(settings) => Method::Nash(Box::new(Nash::new(*settings))),
            Driver::Contingency(settings) => Method::Contingency(Box::new(Contingency::new(*settings))),
        };
        let beliefs = (!self.knows_plans()).then(|| Box::new(DriverBeliefs::new(*inference)));
        Planner {
            method,
            beliefs,
            passing_orders: PassingOrderLog::default(),
            prediction: self.prediction().unwrap_or_default(),
            may_be_refused: !self.goes_first(),
            deadline: None,
        }
    }

    /// How the driver predicts the others; none for one who does not look.
    pub fn prediction(&self) -> Option<Prediction> {
        match self {
            Driver::Human(settings) => Some(settings.prediction),
            Driver::Idm(settings) => Some(settings.prediction),
            Driver::Scripted(_) => None,
            Driver::Conservative(settings) => Some(settings.prediction),
            Driver::Negotiation(settings) => Some(settings.prediction),
            Driver::Bayesian(settings) => Some(settings.prediction),
            Driver::Game(settings) => Some(settings.prediction),
            Driver::Cooperative(settings) => Some(settings.prediction),
            Driver::Nash(settings) => Some(settings.prediction),
            Driver::Contingency(_) => Some(Prediction::Inferred),
        }
    }

    /// Whether the driver is told the plans of the others; one who infers them is not.
    pub fn knows_plans(&self) -> bool {
        self.prediction() != Some(Prediction::Inferred)
    }

    /// The word for this kind of driver in a scenario file.
    pub fn kind(&self) -> &'static str {
        match self {
            Driver::Human(_) => "human",
            Driver::Idm(_) => "idm",
            Driver::Scripted(_) => "scripted",
            Driver::Conservative(_) => "conservative",
            Driver::Negotiation(_) => "negotiation",
            Driver::Bayesian(_) => "bayesian",
            Driver::Game(_) => "game",
            Driver::Cooperative(_) => "cooperative",
            Driver::Nash(_) => "nash",
            Driver::Contingency(_) => "contingency",
        }
    }

    /// The driver in a few words, for legends: the kind, and of a human the style.
    pub fn description(&self) -> String {
        match self {
            Driver::Human(settings) => format!("{}, {}", self.kind(), settings.manner()),
            Driver::Idm(_)
            | Driver::Scripted(_)
            | Driver::Conservative(_)
            | Driver::Negotiation(_)
            | Driver::Bayesian(_)
            | Driver::Game(_)
            | Driver::Cooperative(_)
            | Driver::Nash(_)
            | Driver::Contingency(_) => self.kind().to_owned(),
        }
    }

    /// How this kind of driver explains its plans.
    pub fn explanation(&self) -> &'static Explanation {
        match self {
            Driver::Human(_) => &human::diagnostics::EXPLANATION,
            Driver::Idm(_) => &idm::diagnostics::EXPLANATION,
            Driver::Scripted(_) => &Explanation::NONE,
            Driver::Conservative(_) => &conservative::diagnostics::EXPLANATION,
            Driver::Negotiation(_) => &negotiation::diagnostics::EXPLANATION,
            Driver::Bayesian(_) => &bayesian::diagnostics::EXPLANATION,
            Driver::Game(_) => &game::diagnostics::EXPLANATION,
            Driver::Cooperative(_) => &cooperative::diagnostics::EXPLANATION,
            Driver::Nash(_) => &nash::diagnostics::EXPLANATION,
            Driver::Contingency(_) => &contingency::diagnostics::EXPLANATION,
        }
    }

    /// What a vehicle with this driver and goal tells the others that it wants, if anything.
    pub fn shared_goal(&self, goal: &Goal) -> Option<Goal> {
        match self {
            Driver::Cooperative(settings) => Some(settings.shared_goal(goal)),
            Driver::Human(_)
            | Driver::Idm(_)
            | Driver::Scripted(_)
            | Driver::Conservative(_)
            | Driver::Negotiation(_)
            | Driver::Bayesian(_)
            | Driver::Game(_)
            | Driver::Nash(_)
            | Driver::Contingency(_) => None,
        }
    }

    /// Whether the driver takes notice of vehicles outside its own lane, so that it can be asked to give way. IDM drivers
    /// see the vehicle ahead only, and scripted ones nobody.
    pub fn can_be_asked(&self) -> bool {
        match self {
            Driver::Idm(_) | Driver::Scripted(_) => false,
            Driver::Human(_)
            | Driver::Conservative(_)
            | Driver::Negotiation(_)
            | Driver::Bayesian(_)
            | Driver::Game(_)
            | Driver::Cooperative(_)
            | Driver::Nash(_)
            | Driver::Contingency(_) => true,
        }
    }

    /// Checks settings that depend on each other or on the horizon.
    ///
    /// # Errors
    /// [`DriverSettingError`] names the setting that does not fit.
    pub fn check(&self, horizon_steps: usize) -> Result<(), DriverSettingError> {
        match self {
            Driver::Negotiation(settings) => settings.check(horizon_steps),
            Driver::Bayesian(settings) => settings.check(),
            Driver::Human(_)
            | Driver::Idm(_)
            | Driver::Scripted(_)
            | Driver::Conservative(_)
            | Driver::Game(_)
            | Driver::Cooperative(_)
            | Driver::Nash(_)
            | Driver::Contingency(_) => Ok(()),
        }
    }

    /// Whether the driver plans before those who rely on knowing its plan.
    pub fn goes_first(&self) -> bool {
        match self {
            Driver::Human(_) | Driver::Idm(_) | Driver::Scripted(_) => true,
            Driver::Conservative(_)
            | Driver::Negotiation(_)
            | Driver::Bayesian(_)
            | Driver::Game(_)
            | Driver::Cooperative(_)
            | Driver::Nash(_)
            | Driver::Contingency(_) => false,
        }
    }
}

impl Planner {
    /// The same planner, whose plans have this deadline, or none.
    pub fn with_deadline(self, deadline: Option<PlanDeadline>) -> Self {
        Planner { deadline, ..self }
    }

    /// Plans the next move in a scene in which everybody is seen as it is.
    ///
    /// # Errors
    /// [`PlanError`] if there is no plan; the caller falls back.
    pub fn plan(&mut self, scene: &Scene) -> Result<Plan, PlanError> {
        match self.beliefs {
            Some(_) => self.plan_sensed(&SensedScene::perfect(scene)),
            None => self.plan_as_told(scene, &Outlook::default()),
        }
    }

    /// Plans the next move in a scene as it is sensed, with inferred predictions where the driver is told no plans.
    ///
    /// # Errors
    /// As [`Planner::plan`].
    pub fn plan_sensed(&mut self, sensed: &SensedScene) -> Result<Plan, PlanError> {
        let Some(beliefs) = &mut self.beliefs else {
            return self.plan_as_told(&sensed.scene, &Outlook::default());
        };
        let inferred = beliefs.infer(sensed);
        let branches = matches!(self.method, Method::Contingency(_));
        let outlook = Outlook {
            alternatives: if branches { beliefs.alternatives(sensed, &inferred.scene) } else { Vec::new() },
            estimates: inferred.estimates,
            delay: sensed.oldest_sighting(),
        };
        let mut plan = self.plan_as_told(&inferred.scene, &outlook)?;
        plan.diagnostics.extend(inferred.diagnostics);
        plan.events.splice(0..0, inferred.events);
        plan.beliefs = outlook.estimates;
        Ok(plan)
    }

    /// Plans the next move with the predictions of the scene, and says of a plan with a problem how it passes the others.
    fn plan_as_told(&mut self, scene: &Scene, outlook: &Outlook) -> Result<Plan, PlanError> {
        let mut plan = match &mut self.method {
            Method::Human(planner) => planner.plan(scene),
            Method::Idm(planner) => planner.plan(scene),
            Method::Scripted(planner) => planner.plan(scene),
            Method::Conservative(planner) => planner.plan(scene),
            Method::Negotiation(planner) => planner.plan(scene),
            Method::Bayesian(planner) => planner.plan(scene, outlook),
            Method::Game(planner) => planner.plan(scene, outlook),
            Method::Cooperative(planner) => planner.plan(scene),
            Method::Nash(planner) => planner.plan(scene),
            Method::Contingency(planner) => planner.plan(scene, outlook),
        }?;
        self.deadline.map_or(Ok(()), |deadline| deadline.check(&plan.statistics))?;
        let expected = self.prediction.applied_to(scene);
        plan.violations = violations(&expected, &plan.trajectory);
        let refused = self.may_be_refused.then(|| refused(&expected, &plan.trajectory, &plan.violations)).flatten();
        if let Some(violation) = refused {
            return Err(PlanError::Refused(violation.clone()));
        }
        if plan.problem.is_some() {
            self.passing_orders.note(scene, &mut plan);
        }
        Ok(plan)
    }
}
