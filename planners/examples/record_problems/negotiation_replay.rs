//! The negotiation planner's problem, rebuilt from its scenes and plans by repeating the negotiation.

use interplay_planners::conservative::{self, Conservative};
use interplay_planners::diagnostic::COST;
use interplay_planners::negotiation::{self, Concession, Settings, acceptance};
use interplay_planners::trajectory::{Optimiser, Problem, Robust};
use interplay_planners::{Agent, Input, Plan, Scene, Trajectory};

use crate::{Result, stated};

/// A problem with the guess to start from.
pub type Posed = (Problem, Vec<Vec<Input>>);

/// The state of a negotiation, and planners that repeat what the observed one does unseen.
pub struct NegotiationReplay {
    settings: Settings,
    retreat: Conservative,
    optimiser: Optimiser<Robust>,
    state: Option<NegotiationState>,
}

struct NegotiationState {
    partner: String,
    concession: Concession,
    last: Option<Round>,
}

struct Round {
    cooperative: Trajectory,
    conservative: Trajectory,
    proposal: Trajectory,
    prediction: Trajectory,
}

impl NegotiationReplay {
    /// The view of a planner that has not negotiated yet.
    pub fn new(settings: Settings) -> Self {
        let passing_orders = settings.passing_orders;
        NegotiationReplay {
            settings,
            retreat: Conservative::new(conservative::Settings { passing_orders, ..Default::default() }),
            optimiser: negotiation::optimiser(&settings),
            state: None,
        }
    }

    /// The problem behind a plan, if it proposes something.
    ///
    /// # Errors
    /// The rebuilt problem does not lead to the cost that the plan states.
    pub fn rebuild(&mut self, scene: &Scene, plan: &Plan) -> Result<Option<Posed>> {
        let conservative = self.retreat.plan(scene)?.trajectory;
        let asked = plan.proposal.as_ref().map(|proposal| proposal.to.as_str());
        let Some(partner) = scene.others.iter().find(|other| Some(other.name.as_str()) == asked) else {
            self.state = None;
            return Ok(None);
        };
        let mut state = self.state.take().filter(|state| state.partner == partner.name).unwrap_or_else(|| {
            NegotiationState { partner: partner.name.clone(), concession: Concession::default(), last: None }
        });
        let accepted = update_acceptance(&mut state, partner, &self.settings);
        let strength = 1.0 + self.settings.gamma * accepted;
        let persuasion = state.last.as_ref().and_then(|round| {
            negotiation::persuasion(&round.cooperative.shifted(), &round.conservative.shifted(), strength)
        });
        let weight = state.concession.weight();
        let problem = negotiation::problem(scene, partner, weight, persuasion, &self.settings);
        let own_way = partner.prediction.inputs.clone();
        let mut keep = vec![Vec::new(), own_way.clone()];
        if let Some(round) = &state.last {
            let cooperative = round.cooperative.later_inputs();
            keep = vec![cooperative.clone(), round.proposal.later_inputs()];
            let unasked = vec![cooperative, own_way];
            if problem.cost_of(&unasked) < problem.cost_of(&keep) {
                keep = unasked;
            }
        }
        let optimum = self.optimiser.optimise(&problem, &keep)?;
        if optimum.cost.total != stated(plan, &COST)? {
            return Err(format!("tick {}: the rebuilt negotiation costs {}", scene.tick, optimum.cost.total).into());
        }
        state.last = Some(Round {
            cooperative: optimum.trajectory(0),
            conservative,
            proposal: optimum.trajectory(1),
            prediction: partner.prediction.clone(),
        });
        self.state = Some(state);
        Ok(Some((problem, keep)))
    }
}

/// The acceptance of the last proposal; concedes accordingly.
fn update_acceptance(state: &mut NegotiationState, partner: &Agent, settings: &Settings) -> f64 {
    let Some(round) = &state.last else { return 1.0 };
    let accepted = acceptance(&partner.prediction, &round.prediction.shifted(), &round.proposal.shifted());
    state.concession.concede(accepted, settings.beta, settings.weight_floor);
    accepted
}
