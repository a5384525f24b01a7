//! What a planner reports that infers the others' plans: its belief about the nearest vehicle that it may meet.

use crate::Diagnostic;
use crate::plan::diagnostic::{DiagnosticPanel, DiagnosticQuantity, ValueSet};
use crate::scene::driver_estimate::{DriverEstimate, DriverModel};

/// Probabilities of the kinds of driver, in the order of [`DriverModel::ALL`].
const PROBABILITIES: [DiagnosticQuantity; 5] = [
    probability("belief: tough"),
    probability("belief: normal"),
    probability("belief: nice"),
    probability("belief: IDM"),
    probability("belief: none of these"),
];
/// Mean of the believed safety weight of a human driver.
pub const SAFETY_WEIGHT: DiagnosticQuantity = weight("believed safety weight");
/// Lower end of the interval that holds the safety weight with a probability of at least 0.9.
const SAFETY_WEIGHT_FROM: DiagnosticQuantity = weight("believed safety weight, from");
/// Upper end of the interval that holds the safety weight with a probability of at least 0.9.
const SAFETY_WEIGHT_TO: DiagnosticQuantity = weight("believed safety weight, to");
/// Entropy of the probabilities \[nat\].
const ENTROPY: DiagnosticQuantity = DiagnosticQuantity::new("entropy of the belief", "", ValueSet::NonNegative);

/// All quantities that are reported of a belief.
pub const QUANTITIES: &[DiagnosticQuantity] = &[
    PROBABILITIES[0],
    PROBABILITIES[1],
    PROBABILITIES[2],
    PROBABILITIES[3],
    PROBABILITIES[4],
    SAFETY_WEIGHT,
    SAFETY_WEIGHT_FROM,
    SAFETY_WEIGHT_TO,
    ENTROPY,
];

/// The panels in which a recording shows a belief.
pub const PANELS: &[DiagnosticPanel] = &[
    DiagnosticPanel { title: "What the nearest driver is believed to be [–]", quantities: &PROBABILITIES },
    DiagnosticPanel {
        title: "Its safety weight, with a 90 % interval [–]",
        quantities: &[SAFETY_WEIGHT, SAFETY_WEIGHT_FROM, SAFETY_WEIGHT_TO],
    },
];

/// What is reported of a belief.
pub(super) fn report(estimate: &DriverEstimate) -> Vec<Diagnostic> {
    let kinds = DriverModel::ALL.iter().zip(PROBABILITIES);
    let mut diagnostics: Vec<Diagnostic> =
        kinds.map(|(kind, quantity)| quantity.is(estimate.probability(*kind))).collect();
    let [from, to] = estimate.safety_weight_interval;
    diagnostics.extend([
        SAFETY_WEIGHT.is(estimate.safety_weight),
        SAFETY_WEIGHT_FROM.is(from),
        SAFETY_WEIGHT_TO.is(to),
        ENTROPY.is(estimate.entropy),
    ]);
    diagnostics
}

const fn probability(name: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, "", ValueSet::Probability)
}

const fn weight(name: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, "", ValueSet::NonNegative)
}
