//! What a driver made of another one, for the report.

use serde::Serialize;

use crate::measure::HeldBelief;

/// What a driver believed of another one in the end.
#[derive(Clone, Debug, Serialize)]
pub struct BeliefReport {
    /// The name of the other vehicle.
    pub about: String,
    /// The kind of driver for which it was taken: whose plan was its prediction.
    pub taken_for: String,
    /// The probability of that kind.
    pub probability: f64,
    /// The fewest kinds that contain the driver with a probability of at least 0.9, the likeliest first.
    pub may_be: Vec<&'static str>,
    /// The probability of all of these.
    pub may_be_probability: f64,
    /// Since when it had been taken for that kind \[s\].
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
