//! What the ego remembers of its negotiation with one vehicle.

use super::acceptance::{Acceptance, printed_acceptance, willingness};
use super::concession::Concession;
use crate::{Agent, Scene, Trajectory};

/// A negotiation with one vehicle; it starts anew with the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct NegotiationState {
    /// The weight of the ego's own cost.
    pub concession: Concession,
    /// What the other planned before it was first asked, continued to the next step.
    pub first_plan: Option<Trajectory>,
    /// What the step before led to.
    pub last: Option<NegotiationRound>,
}

impl NegotiationState {
    /// How far the partner accepted the last proposal; none before the first.
    pub fn acceptance(&self, reading: Acceptance, scene: &Scene, partner: &Agent) -> Option<f64> {
        let (round, first_plan) = (self.last.as_ref()?, self.first_plan.as_ref()?);
        Some(match reading {
            Acceptance::Willingness => {
                let ellipse = scene.goal.safety.oriented(partner.corridor.heading_rad);
                willingness(&partner.prediction, first_plan, &round.cooperative.shifted(), &ellipse)
            }
            Acceptance::AsPrinted => {
                printed_acceptance(&partner.prediction, &round.prediction.shifted(), &round.proposal.shifted())
            }
        })
    }
}

/// What one step of a negotiation led to.
#[derive(Clone, Debug)]
pub(super) struct NegotiationRound {
    /// The ego's cooperative plan.
    pub cooperative: Trajectory,
    /// The ego's conservative plan.
    pub conservative: Option<Trajectory>,
    /// What was proposed to the other.
    pub proposal: Trajectory,
    /// What the other was expected to do.
    pub prediction: Trajectory,
}
