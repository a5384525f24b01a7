//! Whether single vehicles stand out among the others.

use crate::model::scenario::Scenario;

/// The most vehicles that are not yet a crowd.
pub(crate) const MOST_TOLD: usize = 40;

impl Scenario {
    /// Whether no vehicle stands out, because the ego is only the first of a flow.
    pub fn is_flow_alone(&self) -> bool {
        self.ego().is_some_and(|ego| self.flows.of(&ego.name).is_some())
    }

    /// Whether recordings and pictures show only the vehicles near the ego, because there are too many.
    pub fn is_crowd(&self) -> bool {
        self.vehicles.len() > MOST_TOLD
    }
}
