//! Cumulative prospect theory: how people value uncertain outcomes (eq. 8.5-8.7).
//!
//! ```text
//! v(x) = x^α  for gains,  −λ (−x)^β  for losses                              (8.5)
//! w(p) = p^κ / (p^κ + (1 − p)^κ)^(1/κ),  κ = γ for gains, η for losses       (8.6, corrected)
//! U = Σ_losses (w⁻(p₁ + … + pᵢ) − w⁻(p₁ + … + pᵢ₋₁)) v(xᵢ)      worst first
//!   + Σ_gains  (w⁺(p₁ + … + pᵢ) − w⁺(p₁ + … + pᵢ₋₁)) v(xᵢ)      best first   (8.7, corrected)
//! ```
//!
//! Corrections of the source: outcomes must be ranked (the text allows "any order", but the weights are those of
//! cumulated probabilities); w⁺ belongs to gains and w⁻ to losses; `δ` in print is `η`; `β > 1` contradicts the 0.88 that is
//! used.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The parameters of Tversky and Kahneman (1992), which the source uses too.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ProspectTheory {
    /// Exponent of the value of gains, `α`.
    #[schemars(range(min = 0.1, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub alpha: f64,
    /// Exponent of the value of losses, `β`.
    #[schemars(range(min = 0.1, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub beta: f64,
    /// Loss aversion, `λ`.
    #[schemars(range(min = 0.1, max = 10.0), extend("x-unit" = "dimensionless"))]
    pub lambda: f64,
    /// How probabilities of gains are distorted, `γ`; 1 not at all.
    #[schemars(range(min = 0.3, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub gamma: f64,
    /// How probabilities of losses are distorted, `η`; 1 not at all.
    #[schemars(range(min = 0.3, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub eta: f64,
}

/// One outcome of a lottery.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Payoff of the outcome.
    pub payoff: f64,
    /// Probability of the outcome.
    pub probability: f64,
}

impl Default for ProspectTheory {
    fn default() -> Self {
        ProspectTheory { alpha: 0.88, beta: 0.88, lambda: 2.25, gamma: 0.61, eta: 0.69 }
    }
}

impl ProspectTheory {
    /// The parameters that make [`ProspectTheory::utility`] the expected payoff.
    pub const EXPECTED: ProspectTheory = ProspectTheory { alpha: 1.0, beta: 1.0, lambda: 1.0, gamma: 1.0, eta: 1.0 };

    /// The value `v` of a payoff (eq. 8.5).
    pub fn value(&self, payoff: f64) -> f64 {
        if payoff >= 0.0 { libm::pow(payoff, self.alpha) } else { -self.lambda * libm::pow(-payoff, self.beta) }
    }

    /// The utility of a lottery (eq. 8.7, corrected); sorts `outcomes` by payoff.
    pub fn utility(&self, outcomes: &mut [Outcome]) -> f64 {
        outcomes.sort_by(|a, b| a.payoff.total_cmp(&b.payoff));
        let gains = outcomes.partition_point(|outcome| outcome.payoff < 0.0);
        let (losses, gains) = outcomes.split_at(gains);
        self.ranked(losses.iter(), self.eta) + self.ranked(gains.iter().rev(), self.gamma)
    }

    /// The contribution of outcomes on one side, the most extreme first.
    fn ranked<'a>(&self, outcomes: impl Iterator<Item = &'a Outcome>, exponent: f64) -> f64 {
        let (mut cumulated, mut weight, mut utility) = (0.0, 0.0, 0.0);
        for outcome in outcomes {
            cumulated += outcome.probability;
            let next = weighting(cumulated, exponent);
            utility += (next - weight) * self.value(outcome.payoff);
            weight = next;
        }
        utility
    }
}

/// The decision weight of a cumulated probability, `w` (eq. 8.6); 0 at 0 and 1 at 1.
pub fn weighting(probability: f64, exponent: f64) -> f64 {
    let p = probability.clamp(0.0, 1.0);
    let (this, that) = (libm::pow(p, exponent), libm::pow(1.0 - p, exponent));
    this / libm::pow(this + that, 1.0 / exponent)
}

/// The derivative of [`weighting`] inside (0, 1).
pub fn weighting_slope(p: f64, exponent: f64) -> f64 {
    let (this, that) = (libm::pow(p, exponent), libm::pow(1.0 - p, exponent));
    let spread = (this / p - that / (1.0 - p)) / (this + that);
    weighting(p, exponent) * (exponent / p - spread)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lottery(pairs: &[(f64, f64)]) -> Vec<Outcome> {
        let total: f64 = pairs.iter().map(|(_, weight)| weight).sum();
        pairs.iter().map(|&(payoff, weight)| Outcome { payoff, probability: weight / total }).collect()
    }

    fn pairs() -> impl Strategy<Value = Vec<(f64, f64)>> {
        prop::collection::vec((-5.0..5.0, 0.01..1.0), 1..6)
    }

    proptest! {
        #[test]
        fn without_distortion_utility_is_the_expected_payoff(pairs in pairs()) {
            let mut lottery = lottery(&pairs);
            let expected: f64 = lottery.iter().map(|outcome| outcome.payoff * outcome.probability).sum();
            prop_assert!((ProspectTheory::EXPECTED.utility(&mut lottery) - expected).abs() < 1e-12);
        }

        #[test]
        fn the_order_in_which_outcomes_are_told_does_not_matter(pairs in pairs()) {
            let theory = ProspectTheory::default();
            let told = theory.utility(&mut lottery(&pairs));
            let backwards: Vec<_> = pairs.iter().rev().copied().collect();
            // Weights are steep at 1: a rounding error there is amplified.
            prop_assert!((told - theory.utility(&mut lottery(&backwards))).abs() < 1e-8);
        }

        /// First-order stochastic dominance: ranking is what makes this hold.
        #[test]
        fn a_better_payoff_is_worth_more(pairs in pairs(), which in 0_usize..6, more in 0.0..2.0) {
            let mut better = pairs.clone();
            let index = which % pairs.len();
            better[index].0 += more;
            let theory = ProspectTheory::default();
            prop_assert!(theory.utility(&mut lottery(&better)) >= theory.utility(&mut lottery(&pairs)) - 1e-12);
        }

        #[test]
        fn a_certain_outcome_is_worth_its_value(payoff in -5.0..5.0) {
            let theory = ProspectTheory::default();
            let certain = theory.utility(&mut [Outcome { payoff, probability: 1.0 }]);
            prop_assert!((certain - theory.value(payoff)).abs() < 1e-12);
        }

        #[test]
        fn the_slope_of_the_weighting_agrees_with_differences(p in 0.01..0.99, exponent in 0.4..1.0) {
            let step = 1e-6;
            let numeric = (weighting(p + step, exponent) - weighting(p - step, exponent)) / (2.0 * step);
            prop_assert!((numeric - weighting_slope(p, exponent)).abs() < 1e-6 * (1.0 + numeric.abs()));
        }
    }

    #[test]
    fn small_probabilities_weigh_more_and_large_ones_less() {
        let theory = ProspectTheory::default();
        for exponent in [theory.gamma, theory.eta] {
            assert!(weighting(0.05, exponent) > 0.05 && weighting(0.9, exponent) < 0.9);
            assert_eq!((weighting(0.0, exponent), weighting(1.0, exponent)), (0.0, 1.0));
        }
    }

    /// Figures of Tversky and Kahneman: half of people find this fair.
    #[test]
    fn a_loss_hurts_more_than_an_equal_gain_pleases() {
        let theory = ProspectTheory::default();
        let coin = |win: f64| {
            theory
                .utility(&mut [Outcome { payoff: win, probability: 0.5 }, Outcome { payoff: -100.0, probability: 0.5 }])
        };
        assert!(coin(100.0) < 0.0 && coin(202.0) < 0.0 && coin(300.0) > 0.0);
    }
}
