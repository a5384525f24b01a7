//! What the ego remembers of its negotiation with one vehicle.

use super::concession::Concession;
use crate::Trajectory;

/// A negotiation with one vehicle; it starts anew with the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct NegotiationState {
    /// The weight of the ego's own cost.
    pub concession: Concession,
    /// What the step before led to.
    pub last: Option<NegotiationRound>,
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
