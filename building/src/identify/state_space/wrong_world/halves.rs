//! Split-half agreement: the chosen model fitted to each half of the record.

use crate::identify::state_space::likelihood::Observations;
use crate::identify::state_space::quantities::{Precision, QuantityKind, logarithm};
use crate::identify::state_space::selection::Fit;
use crate::identify::telemetry::Telemetry;

const MOST_STEPS: usize = 25;
/// Halves contradict each other if they are this many standard errors of their difference apart …
const CONTRADICTION: f64 = 3.0;
/// … or fewer if they are also far apart, as a difference of logarithms.
const CONTRADICTION_OF_FAR: (f64, f64) = (1.96, 0.25);
/// Number of standard errors from which on the record itself is suspected.
const SUSPICION: f64 = 4.0;

pub(in crate::identify::state_space) struct Halves {
    fits: [(Fit, Precision); 2],
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
        self.distance > CONTRADICTION || (self.distance > distance && self.log_ratio > log_ratio)
    }

    /// Whether the halves differ so much that the record itself is suspected.
    pub fn is_suspicious(&self) -> bool {
        self.distance > SUSPICION
    }
}

impl Halves {
    /// Fits the model to both halves; `None` if a half has no likelihood.
    pub fn new(fit: &Fit, observations: &Observations) -> Option<Self> {
        let rows: usize = observations.segments.iter().map(std::ops::Range::len).sum();
        let of = |half: &Observations| {
            let fit = fit.refit(half, MOST_STEPS)?;
            let precision = Precision::new(&fit);
            Some((fit, precision))
        };
        let (first, second) =
            rayon::join(|| of(&observations.beginning(rows / 2)), || of(&observations.ending(rows / 2)));
        Some(Self { fits: [first?, second?] })
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
}
