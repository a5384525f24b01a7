//! Negotiation with concession and persuasion (chapter 6).
//!
//! At every step the planner
//!
//! 1. makes a conservative plan (eq. 6.13), its retreat;
//! 2. chooses whom to ask (`partner_selection`);
//! 3. reads from the other's new prediction how far the last proposal was accepted ([`Acceptance`], eq. 6.19);
//! 4. concedes: lowers the weight of its own cost the less it was accepted (`concession`, eq. 6.18);
//! 5. stays nearer to what it first proposed than to its first retreat, the more the better it was received
//!    ([`persuasion()`], eq. 6.20-6.23);
//! 6. solves for its own plan and a proposal to the other at once (`proposal`, eq. 6.24);
//! 7. applies the first input only if a conservative plan still exists after it (`filter`).

mod acceptance;
mod concession;
pub mod diagnostics;
mod filter;
mod partner_selection;
mod persuasion;
mod proposal;
mod references;
mod settings;
mod state;

pub use acceptance::Acceptance;
pub use persuasion::persuasion;
pub use proposal::{optimiser, problem};
pub use references::References;
pub use settings::Settings;

use crate::conservative::{self, Conservative};
use crate::diagnostic::{COST, RUNNER_UP_COST, SAFETY_SLACK};
use crate::encounter::partner_event;
use crate::solo::Solved;
use crate::trajectory::activity::Activity;
use crate::trajectory::terms::Persuasion;
use crate::trajectory::{Optimiser, Optimum, Problem, Robust, Violation};
use crate::{Agent, Input, Plan, PlanError, PlanEvent, PlanEventKind, Proposal, Scene};
use diagnostics::{ACCEPTANCE, CONCESSION_WEIGHT, PERSUASION_ACTIVE, PERSUASION_STRENGTH, SAFETY_FILTER};
use filter::Filter;
use partner_selection::PartnerSelection;
use state::{NegotiationRound, NegotiationState};

/// A negotiating planner with what it remembers.
#[derive(Clone, Debug)]
pub struct Negotiation {
    settings: Settings,
    retreat: Conservative,
    filter: Filter,
    optimiser: Optimiser<Robust>,
    selection: PartnerSelection,
    negotiation: NegotiationState,
}

impl Negotiation {
    /// A planner that has not negotiated yet.
    pub fn new(settings: Settings) -> Self {
        let passing_orders = settings.passing_orders;
        Negotiation {
            settings,
            retreat: Conservative::new(conservative::Settings { passing_orders, ..Default::default() }),
            filter: Filter::default(),
            optimiser: optimiser(&settings),
            selection: PartnerSelection::default(),
            negotiation: NegotiationState::default(),
        }
    }

    /// Plans the next move and the next proposal.
    ///
    /// # Errors
    /// [`PlanError`] if neither the negotiation nor the conservative problem can be solved.
    pub fn plan(&mut self, scene: &Scene) -> Result<Plan, PlanError> {
        let scene = &self.settings.prediction.applied_to(scene);
        let retreat = self.retreat.optimise(scene).map_err(PlanError::from);
        let mut events = Vec::new();
        let Some(partner) = self.choose(scene, &mut events) else {
            return Ok(Plan { events, ..conservative::answer(retreat?) });
        };
        let accepted = self.update_acceptance(scene, partner);
        let persuasion = {
            let scale = scene.ego.body.scale;
            persuasion::next_constraint(&self.settings, &self.negotiation, accepted, scale)
        };
        let outcome = self.propose(scene, partner, persuasion.clone());
        let Solved { problem, optimum, .. } = match outcome {
            Ok(solved) => solved,
            Err(error) => {
                let text = "finds no proposal".to_owned();
                events.push(PlanEvent { kind: PlanEventKind::NoProposal(error.to_string()), text });
                return Ok(Plan { events, ..conservative::answer(retreat?) });
            }
        };
        self.remember(&optimum, &retreat, partner);
        let mut plan = self.to_plan(scene, (&optimum, partner), accepted, persuasion.as_ref());
        plan.diagnostics.extend(optimum.runner_up_cost.map(|cost| RUNNER_UP_COST.is(cost)));
        plan.diagnostics.extend(Activity::of(&problem, &optimum.iterate, 0).diagnostics());
        plan.events = events;
        plan.problem = Some(Box::new(problem));
        self.filter(scene, &retreat, &optimum, &mut plan);
        Ok(plan)
    }

    /// Chooses the vehicle to negotiate with; notes a change as an event.
    fn choose<'a>(&mut self, scene: &'a Scene, events: &mut Vec<PlanEvent>) -> Option<&'a Agent> {
        let before = self.selection.current().map(str::to_owned);
        let partner = self.selection.choose(scene, &self.settings);
        let now = partner.map(|partner| partner.name.clone());
        if before != now {
            self.negotiation = NegotiationState::default();
            events.push(partner_event(now.as_deref(), "asks", "to ask"));
        }
        partner
    }

    /// How far the last proposal was accepted; the ego concedes accordingly. Before the first proposal it is 1.
    fn update_acceptance(&mut self, scene: &Scene, partner: &Agent) -> f64 {
        let accepted = self.negotiation.acceptance(self.settings.acceptance, scene, partner);
        if let Some(accepted) = accepted {
            if self.settings.concession {
                self.negotiation.concession.concede(accepted, self.settings.beta, self.settings.least_weight());
            }
            self.selection.record(accepted, &self.settings);
        }
        accepted.unwrap_or(1.0)
    }

    /// The ego's plan and the proposal to the partner at their joint optimum.
    fn propose(&mut self, scene: &Scene, partner: &Agent, persuasion: Option<Persuasion>) -> Result<Solved, PlanError> {
        let problem = problem(scene, partner, self.negotiation.concession.weight(), persuasion, &self.settings);
        let keep = self.guess(&problem, partner);
        let optimum = self.optimiser.optimise(&problem, &keep)?;
        Ok(Solved { problem, optimum, event: None })
    }

    /// The starting guess: the plans of the last round one step later. The other may plan differently by now, so that the last
    /// proposal costs more than the other's new plan; the cheaper of the two is taken.
    fn guess(&self, problem: &Problem, partner: &Agent) -> Vec<Vec<Input>> {
        let own_way = partner.prediction.inputs.clone();
        let Some(round) = &self.negotiation.last else { return vec![Vec::new(), own_way] };
        let cooperative = round.cooperative.later_inputs();
        let proposed = vec![cooperative.clone(), round.proposal.later_inputs()];
        let unasked = vec![cooperative, own_way];
        if problem.cost_of(&proposed) <= problem.cost_of(&unasked) { proposed } else { unasked }
    }

    /// Keeps what this round led to for the next one.
    fn remember(&mut self, optimum: &Optimum, retreat: &Result<Solved, PlanError>, partner: &Agent) {
        self.negotiation.remember(NegotiationRound {
            cooperative: optimum.trajectory(0),
            conservative: retreat.as_ref().ok().map(|retreat| retreat.optimum.trajectory(0)),
            proposal: optimum.trajectory(1),
            prediction: partner.prediction.clone(),
        });
    }

    /// The answer of the planner for an optimum of the negotiation problem.
    fn to_plan(
        &self,
        scene: &Scene,
        (optimum, partner): (&Optimum, &Agent),
        accepted: f64,
        persuasion: Option<&Persuasion>,
    ) -> Plan {
        let trajectory = optimum.trajectory(0);
        let active =
            persuasion.is_some_and(|persuasion| persuasion::is_active(persuasion, &trajectory, scene.ego.body.scale));
        Plan {
            trajectory,
            statistics: optimum.statistics,
            proposal: Some(Proposal {
                to: partner.name.clone(),
                trajectory: optimum.trajectory(1),
                acceptance: Some(accepted),
            }),
            diagnostics: vec![
                ACCEPTANCE.is(accepted),
                CONCESSION_WEIGHT.is(self.negotiation.concession.weight()),
                PERSUASION_STRENGTH.is(persuasion.map_or(0.0, |persuasion| persuasion.strength)),
                PERSUASION_ACTIVE.is(f64::from(u8::from(active))),
                COST.is(optimum.cost.total),
                SAFETY_SLACK.is(optimum.cost.violation(Violation::Safety)),
            ],
            ..Plan::default()
        }
    }

    /// Replaces the plan by the retreat where the filter demands it.
    fn filter(&mut self, scene: &Scene, retreat: &Result<Solved, PlanError>, optimum: &Optimum, plan: &mut Plan) {
        let Ok(Solved { optimum: retreat, .. }) = retreat else {
            plan.events.push(PlanEvent::note("has no cautious plan to retreat to"));
            return;
        };
        plan.statistics.add(&retreat.statistics);
        let refused = self.settings.safety_filter && !self.filter.admits(scene, optimum, retreat);
        if refused {
            plan.trajectory = retreat.trajectory(0);
            plan.events.push(PlanEvent::note("drives cautiously: its safety filter asks for it"));
        }
        plan.diagnostics.push(SAFETY_FILTER.is(f64::from(u8::from(refused))));
    }
}
