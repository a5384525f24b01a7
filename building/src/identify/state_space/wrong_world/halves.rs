//! Split-half agreement: the chosen model fitted to each half of the record.

use super::{Explanation, MATERIAL};
use crate::identify::report::SuspectedCause;
use crate::identify::state_space::likelihood::{Observations, log_likelihood};
use crate::identify::state_space::profile::Profiler;
use crate::identify::state_space::quantities::{Precision, QuantityKind, logarithm};
use crate::identify::state_space::selection::Fit;

use crate::identify::telemetry::{Neighbour, Telemetry};

const MOST_STEPS: usize = 25;
/// Halves contradict each other if they are this many standard errors of their difference apart …
const CONTRADICTION: f64 = 3.0;
/// … or fewer if they are also far apart, as a difference of logarithms.
const CONTRADICTION_OF_FAR: (f64, f64) = (1.96, 0.25);
/// Number of standard errors from which on the record itself is suspected.
const SUSPICION: f64 = 4.0;

pub(in crate::identify::state_space) struct Halves {
    fits: [(Fit, Precision); 2],
    /// By how much the log-likelihood of both halves is higher with an estimate for each.
    pub gain: f64,
}

/// What both halves say of a quantity.
pub(in crate::identify::state_space) struct Agreement {
    pub values: [f64; 2],
    /// Standard errors of their difference between them.
    pub distance: f64,
    /// ln of their ratio, as a magnitude.
    log_ratio: f64,
}

impl Agreement {
    /// Whether the halves differ so much that neither estimate can be trusted.
    pub fn is_contradiction(&self) -> bool {
        let (distance, log_ratio) = CONTRADICTION_OF_FAR;
        (self.distance > CONTRADICTION && self.log_ratio > MATERIAL)
            || (self.distance > distance && self.log_ratio > log_ratio)
    }

    /// Whether the halves differ so much that the record itself is suspected.
    pub fn is_suspicious(&self) -> bool {
        self.distance > SUSPICION && self.log_ratio > MATERIAL
    }
}

impl Halves {
    /// Fits the model to both halves; `None` if a half has no likelihood.
    pub fn new(fit: &Fit, observations: &Observations) -> Option<Self> {
        let rows: usize = observations.segments.iter().map(std::ops::Range::len).sum();
        let of = |half: &Observations| {
            let model = |theta: &[crate::identify::state_space::exponential::Number]| fit.structure.model(theta);
            let before = log_likelihood(&model, &fit.maximum.theta, half)?;
            let fit = fit.refit(half, MOST_STEPS)?;
            let (precision, gain) = (Precision::new(&fit), fit.maximum.evaluation.log_likelihood - before);
            Some((fit, precision, gain))
        };
        let (first, second) =
            rayon::join(|| of(&observations.beginning(rows / 2)), || of(&observations.ending(rows / 2)));
        let ((first, one, gain), (second, other, more)) = (first?, second?);
        Some(Self { fits: [(first, one), (second, other)], gain: gain + more })
    }

    /// The estimates of a quantity by the two halves, with standard errors multiplied by `inflation`; `None` if one
    /// half does not determine it.
    pub fn agreement(
        &self,
        telemetry: &Telemetry,
        quantity: (QuantityKind, usize),
        inflation: f64,
    ) -> Option<Agreement> {
        let of = |(fit, precision): &(Fit, Precision)| {
            let (value, gradient) = logarithm(telemetry, &fit.structure, quantity, &fit.maximum.theta)?;
            Some((value, inflation * precision.standard_error(&gradient))).filter(|(_, error)| error.is_finite())
        };
        let ((one, one_error), (other, other_error)) = (of(&self.fits[0])?, of(&self.fits[1])?);
        let log_ratio = (one - other).abs();
        let distance = log_ratio / libm::hypot(one_error, other_error);
        Some(Agreement { values: [libm::exp(one), libm::exp(other)], distance, log_ratio })
    }
    /// Zones on which the halves of the record contradict each other.
    pub fn explanations(&self, profiler: &Profiler<'_>) -> Vec<Explanation> {
        let telemetry = profiler.telemetry;
        let of_zone = |zone: usize| {
            let boundaries = (0..telemetry.boundaries.len()).map(Neighbour::Boundary);
            let conductances = boundaries.map(QuantityKind::Conductance);
            let (kind, agreement) = conductances.chain([QuantityKind::Capacity]).find_map(|kind| {
                let agreement = self.agreement(telemetry, (kind, zone), profiler.inflation_of((kind, zone)))?;
                agreement.is_suspicious().then_some((kind, agreement))
            })?;
            let (name, _, unit) = kind.labels(telemetry);
            let [first, second] = agreement.values;
            let words = format!(
                "the halves of the record contradict each other: {name} {first:.3} {unit} in the first, {second:.3} {unit} \
                 in the second"
            );
            let parameters = profiler.fit.maximum.theta.len();
            Some(Explanation { zone: Some(zone), cause: SuspectedCause::Halves, words, gain: self.gain, parameters })
        };
        (0..telemetry.zones.len()).filter_map(of_zone).collect()
    }
}
