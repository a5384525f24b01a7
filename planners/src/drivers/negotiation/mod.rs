//! Negotiation with concession and persuasion (chapter 6).
//!
//! At every step the planner
//!
//! 1. makes a conservative plan (eq. 6.13), its fallback;
//! 2. chooses whom to ask (`partner_selection`): one vehicle as in the source, or with `partners_at_most` up to three at once;
//! 3. reads from the other's new prediction how far the last proposal was accepted ([`Acceptance`], eq. 6.19);
//! 4. concedes: lowers the weight of its own cost the less it was accepted (`concession`, eq. 6.18);
//! 5. stays nearer to what it first proposed than to its first fallback, the more the better it was received
//!    ([`persuasion()`], eq. 6.20-6.23);
//! 6. solves for its own plan and a proposal to each other that is asked at once (`proposal`, eq. 6.24);
//! 7. goes behind instead, and asks no more, where that has become cheaper by what it concedes ([`Concedes::Order`]); among people it may
//!    ask once more after a pause;
//! 8. applies the first input only if a conservative plan still exists after it, or, among people, if others have the gaps that it owes
//!    them (`filter`).

mod acceptance;
mod baseline;
mod concession;
pub mod diagnostics;
mod filter;
mod partner_selection;
mod patience;
mod persuasion;
mod proposal;
mod references;
mod settings;
mod state;

use std::sync::Arc;

pub use acceptance::Acceptance;
pub use persuasion::persuasion;
pub use proposal::{AskedPartner, optimiser, problem};
pub use references::References;
pub use settings::{Concedes, Settings};

use serde_json::{Map, Value as Json, json};

use crate::drivers::conservative::{self, Conservative};
use crate::drivers::drive::StandardReplacement;
use crate::drivers::drive::{Drive, DriverKind, settings_of};
use crate::drivers::partner_choice::partner_event;
use crate::drivers::receding_horizon::Solved;
use crate::plan::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::scene::inferred_futures::InferredFutures;
use crate::trajectory::activity::Activity;
use crate::trajectory::terms::Persuasion;
use crate::trajectory::{Optimiser, Optimum, Problem, Robust, Violation};
use crate::{Agent, Input, Plan, PlanError, PlanEvent, PlanEventKind, PlanTime, Proposal, Scene};
use concession::Concession;
use diagnostics::{ACCEPTANCE, CONCESSION_WEIGHT, PERSUASION_ACTIVE, PERSUASION_STRENGTH, SAFETY_FILTER};
use filter::Filter;
use partner_selection::{PartnerSelection, passed_by};
use state::{NegotiationRound, NegotiationState};

/// Time after which a person can have answered: its reaction time, a plan, and what it takes until that shows \[s\].
const ANSWER_S: f64 = 1.2;

/// Most work of a descent of the fallback. One that takes more goes to and fro.
const FALLBACK_WORK_LIMIT: usize = 1000;

/// The planner of negotiation (chapter 6) with its last plans and the state of each negotiation.
#[derive(Clone, Debug)]
pub struct Negotiation {
    settings: Settings,
    fallback: Conservative,
    filter: Filter,
    optimiser: Optimiser<Robust>,
    selection: PartnerSelection,
    /// The state of the negotiation with each vehicle that is asked, by name, in the order of asking.
    negotiations: Vec<(String, NegotiationState)>,
}

impl Negotiation {
    /// A planner that has not negotiated yet.
    pub fn new(settings: Settings) -> Self {
        let passing_orders = settings.passing_orders;
        Negotiation {
            settings,
            fallback: Conservative::new(conservative::Settings { passing_orders, ..Default::default() })
                .limited_to(FALLBACK_WORK_LIMIT),
            filter: Filter::default(),
            optimiser: optimiser(&settings),
            selection: PartnerSelection::default(),
            negotiations: Vec::new(),
        }
    }
}

impl DriverKind for Settings {
    fn kind(&self) -> &'static str {
        "negotiation"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(Negotiation::new(*self))
    }

    fn plan_time(&self) -> PlanTime {
        PlanTime { alone_s: 1.0e-3, share_of_each_other: 0.27 }.searching(self.passing_orders)
    }

    fn explanation(&self) -> &'static crate::plan::diagnostic::Explanation {
        &diagnostics::EXPLANATION
    }

    fn prediction(&self) -> Option<crate::prediction::Prediction> {
        Some(self.prediction)
    }

    /// Checks that plans reach beyond the steps during which the other is assumed to follow its prediction.
    fn check(&self, horizon_steps: usize) -> Result<(), crate::DriverSettingError> {
        if self.settled_steps < horizon_steps {
            return Ok(());
        }
        Err(crate::DriverSettingError::BeyondHorizon {
            key: "settled_steps",
            steps: self.settled_steps,
            horizon_steps,
            because: "a plan must reach beyond the steps during which the other is assumed to follow the prediction",
        })
    }

    /// Persuasion has no effect among people (`docs/evidence/people.md`), and costs a constraint.
    fn people_defaults(&self) -> Map<String, Json> {
        let defaults = [("answer_s", json!(ANSWER_S)), ("concedes", json!("order")), ("persuasion", json!(false))];
        defaults.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
    }

    fn replacement_in_why(&self) -> Option<StandardReplacement> {
        Some(StandardReplacement::planner(0))
    }

    fn rank_beside_person(&self) -> Option<u8> {
        Some(0)
    }
}

impl Drive for Negotiation {
    /// Makes a plan and proposals for the scene.
    ///
    /// # Errors
    /// [`PlanError`] if neither the negotiation nor the conservative problem can be solved.
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let scene = &self.settings.prediction.applied_to(scene);
        let fallback = self.fallback.optimise(scene).map_err(PlanError::from);
        let mut events = Vec::new();
        let partners = self.choose(scene, &passed_by(scene, &fallback), &mut events);
        if partners.is_empty() {
            return Ok(Plan { events, ..conservative::answer(fallback?) });
        }
        let accepted = self.update_acceptance(
            scene,
            &partners,
            fallback.as_ref().ok().map(|fallback| fallback.optimum.cost.total),
        );
        let persuasion = self.persuasion(scene, &accepted);
        let outcome = self.propose(scene, &partners, persuasion.clone());
        let Solved { problem, optimum, .. } = match outcome {
            Ok(solved) => solved,
            Err(error) => {
                let text = "finds no proposal".to_owned();
                events.push(PlanEvent { kind: PlanEventKind::NoProposal(error.to_string()), text });
                return Ok(Plan { events, ..conservative::answer(fallback?) });
            }
        };
        if let Some(fallback) =
            fallback.as_ref().ok().filter(|fallback| self.concedes(scene, &partners, &accepted, &optimum, fallback))
        {
            let names: Vec<&str> = partners.iter().map(|partner| &*partner.name).collect();
            events.push(PlanEvent::note(format!("concedes: goes behind {}", names.join(", "))));
            self.selection.concede(scene);
            return Ok(Plan { events, ..conservative::answer(fallback.clone()) });
        }
        self.remember(scene, &optimum, &fallback, &partners);
        let mut plan = self.to_plan(scene, &optimum, &partners, &accepted, persuasion.as_ref());
        plan.diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
        plan.diagnostics.extend(Activity::count(&problem, &optimum.iterate, 0).diagnostics());
        plan.events = events;
        plan.problem = Some(Arc::new(problem));
        self.filter(scene, &fallback, &optimum, &mut plan);
        Ok(plan)
    }

    fn fork(&self) -> Option<Box<dyn Drive>> {
        Some(Box::new(self.clone()))
    }

    fn with_settings(&self, settings: &dyn DriverKind) -> Option<Box<dyn Drive>> {
        let settings = *settings_of::<Settings>(settings)?;
        Some(Box::new(Negotiation {
            fallback: self.fallback.searching(settings.passing_orders),
            optimiser: self.optimiser.clone().searching(settings.passing_orders),
            settings,
            ..self.clone()
        }))
    }
}

impl Negotiation {
    /// Chooses the vehicles to negotiate with, none of those that the fallback has `passed`; notes a change as an event. What is
    /// known of a negotiation that goes on stays.
    fn choose<'a>(&mut self, scene: &'a Scene, passed: &[String], events: &mut Vec<PlanEvent>) -> Vec<&'a Agent> {
        let partners = self.selection.choose(scene, &self.settings, passed);
        let mut before = std::mem::take(&mut self.negotiations);
        if partners.is_empty() && !before.is_empty() {
            events.push(partner_event(None, "asks", "to ask"));
        }
        for partner in &partners {
            let goes_on = before.iter().position(|(name, _)| *name == partner.name);
            if goes_on.is_none() {
                events.push(partner_event(Some(&partner.name), "asks", "to ask"));
            }
            let begun = || (partner.name.clone(), NegotiationState::default());
            self.negotiations.push(goes_on.map_or_else(begun, |place| before.swap_remove(place)));
        }
        partners
    }

    /// How far each of the last proposals was accepted, none of one that is not answered yet; the ego concedes accordingly.
    fn update_acceptance(
        &mut self,
        scene: &Scene,
        partners: &[&Agent],
        fallback_cost: Option<f64>,
    ) -> Vec<Option<f64>> {
        let settings = &self.settings;
        let answer_steps = (settings.answer_s / scene.step_s).round() as usize;
        let pairs = self.negotiations.iter_mut().zip(partners);
        let mut answers = Vec::new();
        let mut answer = |((_, negotiation), partner): (&mut (String, NegotiationState), &&Agent)| {
            negotiation.advance(scene, partner);
            let accepted = negotiation.acceptance(settings.acceptance, scene, partner);
            answers.push(accepted);
            // What a vehicle does before it can have answered does not count where only its motion is seen.
            let answered =
                accepted.filter(|_| !scene.knowledge.is_of_motion() || negotiation.asked_steps >= answer_steps);
            if let Some(accepted) = answered.filter(|_| settings.concession) {
                negotiation.concession.concede(accepted, settings.beta, settings.least_weight());
            }
            answered
        };
        let accepted = pairs.map(&mut answer).collect();
        self.selection.record(&answers, fallback_cost, settings, answer_steps);
        accepted
    }

    /// The persuasion constraint: of several negotiations, that of the vehicle which accepts least. Where only motion is seen it waits for
    /// the answers.
    fn persuasion(&self, scene: &Scene, accepted: &[Option<f64>]) -> Option<Persuasion> {
        if scene.knowledge.is_of_motion() && accepted.contains(&None) {
            return None;
        }
        let scale = scene.ego.body.scale;
        let accepted = accepted.iter().map(|accepted| accepted.unwrap_or(1.0));
        let least = accepted.zip(&self.negotiations).min_by(|(a, _), (b, _)| a.total_cmp(b));
        least.and_then(|(accepted, (_, state))| persuasion::next_constraint(&self.settings, state, accepted, scale))
    }

    /// The ego's plan and the proposals to the partners at their joint optimum.
    fn propose(
        &mut self,
        scene: &Scene,
        partners: &[&Agent],
        persuasion: Option<Persuasion>,
    ) -> Result<Solved, PlanError> {
        let asked = match self.settings.concedes {
            Concedes::Cost => self.asked(partners),
            Concedes::Order => {
                let weight = Concession::default().weight();
                partners.iter().map(|agent| AskedPartner { agent, weight }).collect()
            }
        };
        let problem = problem(scene, &asked, persuasion, &self.settings);
        let keep = self.guess(&problem, partners);
        let optimum = self.optimiser.optimise(&problem, &keep)?;
        Ok(Solved { problem, optimum, event: None })
    }

    /// Those that are asked, with the weight that concession to each has left to the ego's cost.
    fn asked<'a>(&self, partners: &[&'a Agent]) -> Vec<AskedPartner<'a>> {
        let pairs = partners.iter().zip(&self.negotiations);
        pairs.map(|(agent, (_, negotiation))| AskedPartner { agent, weight: negotiation.concession.weight() }).collect()
    }

    /// Whether the ego rather goes behind: at the weights that concession has left, its fallback, with the others as they are
    /// predicted, costs less than its proposal.
    fn concedes(
        &self,
        scene: &Scene,
        partners: &[&Agent],
        accepted: &[Option<f64>],
        proposal: &Optimum,
        fallback: &Solved,
    ) -> bool {
        let awaits_answer = scene.knowledge.is_of_motion() && accepted.contains(&None);
        if self.settings.concedes != Concedes::Order || !self.settings.concession || awaits_answer {
            return false;
        }
        let problem = problem(scene, &self.asked(partners), None, &self.settings);
        let predicted = partners.iter().map(|partner| partner.prediction.inputs.clone());
        let behind: Vec<_> = std::iter::once(fallback.optimum.trajectory(0).inputs).chain(predicted).collect();
        problem.cost_of(&behind) < problem.cost_of(&proposal.iterate.inputs)
    }

    /// The starting guess: the plans of the last round one step later. The others may plan differently by now, so that the last
    /// proposals cost more than their new plans; the cheaper of the two is taken.
    fn guess(&self, problem: &Problem, partners: &[&Agent]) -> Vec<Vec<Input>> {
        let own_ways = partners.iter().map(|partner| partner.prediction.inputs.clone());
        let rounds = self.negotiations.iter().map(|(_, negotiation)| negotiation.last.as_ref());
        let Some(known) = rounds.clone().flatten().next() else {
            return std::iter::once(Vec::new()).chain(own_ways).collect();
        };
        let cooperative = known.cooperative.later_inputs();
        let later = rounds.zip(own_ways.clone());
        let proposals = later.map(|(round, own_way)| round.map_or(own_way, |round| round.proposal.later_inputs()));
        let proposed: Vec<Vec<Input>> = std::iter::once(cooperative.clone()).chain(proposals).collect();
        let unasked: Vec<Vec<Input>> = std::iter::once(cooperative).chain(own_ways).collect();
        if problem.cost_of(&proposed) <= problem.cost_of(&unasked) { proposed } else { unasked }
    }

    /// Keeps what this round led to for the next one.
    fn remember(
        &mut self,
        scene: &Scene,
        optimum: &Optimum,
        fallback: &Result<Solved, PlanError>,
        partners: &[&Agent],
    ) {
        let conservative = fallback.as_ref().ok().map(|fallback| fallback.optimum.trajectory(0));
        for (index, ((_, negotiation), partner)) in self.negotiations.iter_mut().zip(partners).enumerate() {
            let round = NegotiationRound {
                cooperative: optimum.trajectory(0),
                conservative: conservative.clone(),
                proposal: optimum.trajectory(index + 1),
                prediction: (*partner.prediction).clone(),
            };
            negotiation.ask(scene, partner, &round.proposal);
            negotiation.remember(round);
        }
    }

    /// The answer of the planner for an optimum of the negotiation problem. Of several acceptances and weights the least is told.
    fn to_plan(
        &self,
        scene: &Scene,
        optimum: &Optimum,
        partners: &[&Agent],
        accepted: &[Option<f64>],
        persuasion: Option<&Persuasion>,
    ) -> Plan {
        let trajectory = optimum.trajectory(0);
        let active =
            persuasion.is_some_and(|persuasion| persuasion::is_active(persuasion, &trajectory, scene.ego.body.scale));
        let proposals = partners.iter().zip(accepted).enumerate().map(|(index, (partner, accepted))| Proposal {
            to: partner.name.clone(),
            trajectory: optimum.trajectory(index + 1),
            // Among told plans a proposal counts as accepted until it is answered.
            acceptance: accepted.or((!scene.knowledge.is_of_motion()).then_some(1.0)),
        });
        let has_answer = !scene.knowledge.is_of_motion() || accepted.iter().any(Option::is_some);
        let acceptance = has_answer.then(|| ACCEPTANCE.is(accepted.iter().flatten().copied().fold(1.0, f64::min)));
        let weights = self.negotiations.iter().map(|(_, negotiation)| negotiation.concession.weight());
        Plan {
            trajectory,
            statistics: optimum.statistics,
            proposals: proposals.collect(),
            diagnostics: Vec::from_iter(acceptance.into_iter().chain([
                CONCESSION_WEIGHT.is(weights.fold(1.0, f64::min)),
                PERSUASION_STRENGTH.is(persuasion.map_or(0.0, |persuasion| persuasion.strength)),
                PERSUASION_ACTIVE.is(f64::from(u8::from(active))),
                COST.is(optimum.cost.total),
                SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety)),
            ])),
            ..Plan::default()
        }
    }

    /// Replaces the plan by the fallback where the filter demands it.
    fn filter(&mut self, scene: &Scene, fallback: &Result<Solved, PlanError>, optimum: &Optimum, plan: &mut Plan) {
        let Ok(Solved { optimum: fallback, .. }) = fallback else {
            plan.events.push(PlanEvent::note("has no cautious plan to retreat to"));
            return;
        };
        plan.statistics.add(&fallback.statistics);
        let refused = if self.settings.safety_filter { self.filter.refuses(scene, optimum, fallback) } else { None };
        if let Some(reason) = refused {
            let asked = std::mem::replace(&mut plan.trajectory, fallback.trajectory(0));
            plan.announced = scene.knowledge.is_of_motion().then_some(asked);
            plan.events.push(PlanEvent::note(format!("drives cautiously: {reason}")));
        }
        plan.diagnostics.push(SAFETY_FILTER.is(f64::from(u8::from(refused.is_some()))));
    }
}
