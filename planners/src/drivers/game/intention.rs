//! How an intention shows in behaviour, and how behaviour betrays an intention (eq. 8.1-8.4, 8.12-8.15).
//!
//! A vehicle that yields and one that passes are expected to behave differently: their observed quantity `z` (mean speed,
//! or time of arrival) is normal about `μ_y` or `μ_p` with the same deviation `σ`. Then
//!
//! ```text
//! logit p(pass | z) = logit p(pass) + (μ_p − μ_y)(2z − μ_p − μ_y)/(2σ²)                     (8.1)
//! ```
//!
//! is linear in `z`, so an interval of posteriors is an interval of behaviours: eq. 8.14 for speeds and 8.15 for
//! arrivals are this equation solved for `z`. (In print the bounds of 8.15 are swapped: it forgets that `μ_p < μ_y` for
//! arrivals.)
//!
//! Eq. 8.1 repeated reaches 1 exactly after some 37 steps, and then 8.12 has the logarithm of 0: posteriors are clipped to
//! [0.05, 0.95] and forget a share towards ½ at every step.

use super::best_response::{MAX_INTENTION, MIN_INTENTION};

/// The observed quantity as it is expected of a vehicle that yields and of one that passes: normal distributions with
/// one standard
/// deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Behaviour {
    /// Mean if the vehicle yields, `μ_y`.
    pub yielding: f64,
    /// Mean if the vehicle passes, `μ_p`.
    pub passing: f64,
    /// Standard deviation in both cases, `σ`.
    pub deviation: f64,
}

impl Behaviour {
    /// The probability that a vehicle passes that behaves like `observed`, `prior` being what was believed before.
    pub fn posterior(&self, prior: f64, observed: f64) -> f64 {
        let evidence = (self.passing - self.yielding) * (2.0 * observed - self.passing - self.yielding)
            / (2.0 * self.deviation * self.deviation);
        let odds = logit(prior) + evidence;
        (1.0 / (1.0 + libm::exp(-odds))).clamp(MIN_INTENTION, MAX_INTENTION)
    }

    /// The observation that turns a prior probability of passing into a posterior one, by Bayes' rule.
    pub fn expressing(&self, posterior: f64, prior: f64) -> f64 {
        let evidence = logit(posterior) - logit(prior);
        let spread = self.deviation * self.deviation / (self.passing - self.yielding);
        0.5 * (self.passing + self.yielding) + spread * evidence
    }
}

/// A belief that fades: a share of the way from `probability` to what is believed of a driver who has shown nothing.
pub fn forget(probability: f64, share: f64, usual: f64) -> f64 {
    (1.0 - share) * probability + share * usual
}

fn logit(p: f64) -> f64 {
    libm::log(p / (1.0 - p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn behaviour() -> impl Strategy<Value = Behaviour> {
        (-3.0..3.0, 0.1..2.0, any::<bool>(), 0.2..2.0).prop_map(|(yielding, gap, more, deviation)| Behaviour {
            yielding,
            passing: if more { yielding + gap } else { yielding - gap },
            deviation,
        })
    }

    proptest! {
        /// Eq. 8.1 with the densities written out.
        #[test]
        fn the_posterior_is_bayes_rule(behaviour in behaviour(), prior in 0.1_f64..0.9, offset in -0.5_f64..0.5) {
            let Behaviour { yielding, passing, deviation } = behaviour;
            let observed = 0.5 * (yielding + passing) + offset;
            let density = |mean: f64| -> f64 { libm::exp(-(observed - mean).powi(2) / (2.0 * deviation * deviation)) };
            let (pass, yields) = (density(passing) * prior, density(yielding) * (1.0 - prior));
            let expected = (pass / (pass + yields)).clamp(MIN_INTENTION, MAX_INTENTION);
            prop_assert!((behaviour.posterior(prior, observed) - expected).abs() < 1e-9);
        }

        #[test]
        fn what_expresses_a_posterior_leads_to_it(behaviour in behaviour(), prior in 0.06..0.94, posterior in 0.06..0.94) {
            let shown = behaviour.expressing(posterior, prior);
            prop_assert!((behaviour.posterior(prior, shown) - posterior).abs() < 1e-9);
        }
    }

    /// Eq. 8.14 as printed, for the lower bound of the mean speed.
    #[test]
    fn the_printed_bound_on_the_mean_speed_comes_out() {
        let speeds = Behaviour { yielding: 0.7, passing: 1.3, deviation: 0.2 };
        let (posterior, prior) = (0.6_f64, 0.4_f64);
        let left = 2.0 * 0.2 * 0.2 / (1.3 - 0.7) * (posterior * (1.0 - prior) / (prior * (1.0 - posterior))).ln();
        assert!((2.0 * speeds.expressing(posterior, prior) - 1.3 - 0.7 - left).abs() < 1e-12);
    }

    #[test]
    fn beliefs_stay_in_their_bounds_and_fade() {
        let speeds = Behaviour { yielding: 0.7, passing: 1.3, deviation: 0.2 };
        let mut belief = 0.5;
        (0..100).for_each(|_| belief = speeds.posterior(forget(belief, 0.1, 0.5), 1.4));
        assert_eq!(belief, MAX_INTENTION);
        (0..100).for_each(|_| belief = speeds.posterior(forget(belief, 0.1, 0.5), 1.0));
        assert!((belief - 0.5).abs() < 1e-3);
    }
}
