//! Intervals that allow for the next larger model, which the selection rejected but which may be the right one.
//!
//! ```text
//! Σ_i w_i P(Z > (f − f_i)/s_i) = 2.5 %,      w ∝ exp(−AIC/2)
//! ```
//!
//! at the upper end f of an interval of 95 %, with estimate f_i and standard error s_i of either model (Turek and Fletcher,
//! "Model-averaged Wald confidence intervals", *Computational Statistics and Data Analysis* 56, 2012). The estimate stays that of
//! the chosen model, and no end is nearer to it than that of its own interval.

use crate::identify::diagnostics::{STANDARD_ERRORS_OF_95_PERCENT, survival};

/// Halvings of the bracket of an end.
const HALVINGS: usize = 50;
/// What lies beyond each end.
const TAIL: f64 = 0.025;

/// What the next larger model says of a quantity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rival {
    /// w of the larger model. Schwarz's criterion chose the smaller one; Akaike's, which w is made of, may still prefer this one.
    weight: f64,
    /// Its estimate less that of the chosen model.
    offset: f64,
    /// Its standard error.
    error: f64,
}

impl Rival {
    /// Weights the larger model by how much its −AIC/2 exceeds that of the chosen model.
    pub fn new(criterion_gain: f64, offset: f64, error: f64) -> Self {
        Self { weight: 1.0 / (1.0 + libm::exp(-criterion_gain)), offset, error }
    }

    /// The same model as seen towards one end of the interval: its offset multiplied by `sign`.
    pub fn towards(self, sign: f64) -> Self {
        Self { offset: sign * self.offset, ..self }
    }

    /// The upper end of the averaged interval, given that of the chosen model's own interval; both as distances from its estimate.
    pub fn averaged_end(&self, own: f64) -> f64 {
        let own_error = own / STANDARD_ERRORS_OF_95_PERCENT;
        let beyond = |end: f64| {
            (1.0 - self.weight) * upper_tail(end / own_error)
                + self.weight * upper_tail((end - self.offset) / self.error)
        };
        let (mut low, mut high) = (own, own.max(self.offset + STANDARD_ERRORS_OF_95_PERCENT * self.error));
        if beyond(low) <= TAIL {
            return own;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if beyond(middle) > TAIL {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// P(Z > z) of the standard normal distribution.
fn upper_tail(z: f64) -> f64 {
    let half = 0.5 * survival(z * z, 1.0);
    if z >= 0.0 { half } else { 1.0 - half }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published values of the normal distribution.
    #[test]
    fn upper_tails_match_published_values_of_the_normal_distribution() {
        for (z, tail) in [(0.0, 0.5), (1.0, 0.158_655), (1.959_964, 0.025), (-1.0, 0.841_345), (3.0, 0.001_350)] {
            assert!((upper_tail(z) - tail).abs() < 1e-6, "{z}: {}", upper_tail(z));
        }
    }

    #[test]
    fn an_agreeing_or_improbable_alternative_does_not_widen_the_interval() {
        let own = STANDARD_ERRORS_OF_95_PERCENT * 0.01;
        assert!((Rival::new(0.0, 0.0, 0.01).averaged_end(own) - own).abs() < 1e-6);
        assert_eq!(Rival::new(-50.0, 0.3, 0.01).averaged_end(own), own);
        assert_eq!(Rival::new(0.0, 0.3, 0.01).towards(-1.0).averaged_end(own), own, "it lies on the other side");
    }

    /// Of two equally probable models that lie far apart, the outer one has all that is beyond the end: 5 % of it.
    #[test]
    fn a_distant_equally_probable_alternative_sets_the_end_of_the_interval() {
        let end = Rival::new(0.0, 1.0, 0.01).averaged_end(0.02);
        assert!((end - (1.0 + 0.01 * 1.644_854)).abs() < 1e-6, "{end}");
    }
}
