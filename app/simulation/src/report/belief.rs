//! The belief of a driver about another one, for the report.

use serde::Serialize;

use crate::measure::HeldBelief;

/// The final belief of a driver about another one.
#[derive(Clone, Debug, Serialize)]
pub struct BeliefReport {
    /// The name of the other vehicle.
    pub about: String,
    /// The most probable kind of driver, whose plan was the prediction.
    pub taken_for: String,
    /// The probability of that kind.
    pub probability: f64,
    /// The smallest set of kinds that contains the driver with a probability of at least 0.9, the most probable first.
    pub may_be: Vec<&'static str>,
    /// The probability of this set.
    pub may_be_probability: f64,
    /// Time since when the driver had been classified as that kind \[s\].
    pub since_s: f64,
    /// Mean of the safety weight, if it is a human.
    pub safety_weight: f64,
    /// Interval that holds the safety weight with a probability of at least 0.9, if it is a human.
    pub safety_weight_interval: [f64; 2],
    /// Entropy of the probabilities of the kinds of driver \[nat\].
    pub entropy: f64,
}

impl BeliefReport {
    pub(super) fn new(held: &HeldBelief) -> Self {
        let HeldBelief { estimate, since_s } = held;
        let credible = estimate.credible_models();
        BeliefReport {
            about: estimate.vehicle.clone(),
            taken_for: estimate.model.name().to_owned(),
            probability: estimate.probability(estimate.model),
            may_be: credible.iter().map(|model| model.name()).collect(),
            may_be_probability: credible.iter().map(|model| estimate.probability(*model)).sum(),
            since_s: *since_s,
            safety_weight: estimate.safety_weight,
            safety_weight_interval: estimate.safety_weight_interval,
            entropy: estimate.entropy,
        }
    }
}
