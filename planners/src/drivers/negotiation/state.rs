//! What the ego remembers of its negotiation with one vehicle.

use super::acceptance::{Acceptance, printed_acceptance, willingness};
use super::baseline::Baseline;
use super::concession::Concession;
use super::references::References;
use crate::{Agent, Scene, Trajectory};

/// A negotiation with one vehicle; it starts anew with the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct NegotiationState {
    /// The weight of the ego's own cost.
    pub concession: Concession,
    /// The plans of the first step of the negotiation, continued to the step before.
    pub first: Option<NegotiationRound>,
    /// The plans of the step before.
    pub last: Option<NegotiationRound>,
    /// Of a vehicle of which only the motion is seen: how it would drive if it had not been asked.
    baseline: Option<Baseline>,
    /// How many steps it has been asked.
    pub asked_steps: usize,
}

impl NegotiationState {
    /// How far the partner accepted the last proposal; none before the first, and where only motion is seen and nothing is asked.
    pub fn acceptance(&self, reading: Acceptance, scene: &Scene, partner: &Agent) -> Option<f64> {
        let (first, last) = (self.first.as_ref()?.continued(), self.last.as_ref()?.continued());
        let ellipse = |centre| scene.goal.safety.oriented(partner.route.heading_at(centre));
        if let Some(baseline) = &self.baseline {
            return baseline.acceptance(partner, &last.cooperative, scene.step_s, ellipse);
        }
        Some(match reading {
            Acceptance::Willingness => willingness(&partner.prediction, &first.prediction, &last.cooperative, ellipse),
            Acceptance::AsPrinted => {
                let scale = partner.body.scale;
                printed_acceptance(&partner.prediction, &last.prediction, &last.proposal, scale)
            }
        })
    }

    /// The round with the references of the persuasion constraint, continued to the present step.
    pub fn round(&self, references: References) -> Option<NegotiationRound> {
        let round = match references {
            References::FirstRound => self.first.as_ref(),
            References::LastRound => self.last.as_ref(),
        };
        round.map(NegotiationRound::continued)
    }

    /// Advances the baseline by one step, where only motion is seen; acceptance is read after it.
    pub fn advance(&mut self, scene: &Scene, partner: &Agent) {
        if let Some(baseline) = &mut self.baseline {
            baseline.advance(scene, partner);
        }
    }

    /// Keeps the partner as it is seen when it is first asked, where only its motion is seen.
    pub fn ask(&mut self, scene: &Scene, partner: &Agent, proposal: &Trajectory) {
        self.asked_steps += 1;
        if scene.knowledge.is_of_motion() && self.baseline.is_none() {
            self.baseline = Some(Baseline::new(partner, proposal));
        }
    }

    /// Stores the plans of a step for the next ones.
    pub fn remember(&mut self, round: NegotiationRound) {
        self.first = Some(self.first.as_ref().map_or_else(|| round.clone(), NegotiationRound::continued));
        self.last = Some(round);
    }
}

/// What one step of a negotiation led to.
#[derive(Clone, Debug)]
pub(super) struct NegotiationRound {
    /// The ego's cooperative plan.
    pub cooperative: Trajectory,
    /// The ego's conservative plan.
    pub conservative: Option<Trajectory>,
    /// The motion that was proposed to the other.
    pub proposal: Trajectory,
    /// The motion that was predicted of the other.
    pub prediction: Trajectory,
}

impl NegotiationRound {
    /// The same plans one step later.
    fn continued(&self) -> NegotiationRound {
        NegotiationRound {
            cooperative: self.cooperative.shifted(),
            conservative: self.conservative.as_ref().map(Trajectory::shifted),
            proposal: self.proposal.shifted(),
            prediction: self.prediction.shifted(),
        }
    }
}
