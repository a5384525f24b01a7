//! How much the ego's own cost counts (eq. 6.18).

/// The weight `w` of the ego's cost against the other's deviation; starts at one half.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Concession {
    weight: f64,
}

impl Default for Concession {
    fn default() -> Self {
        Concession { weight: 0.5 }
    }
}

impl Concession {
    /// The present weight `w` of the ego's cost.
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// `w ← max(floor, w β^{1 − p_a})`: a refusal costs a factor `β`, full acceptance nothing. A floor above the present
    /// weight does not raise it.
    ///
    /// Eq. 6.18 has no floor; without one the ego's cost vanishes for good.
    pub fn concede(&mut self, accepted: f64, beta: f64, floor: f64) {
        self.weight = (self.weight * libm::pow(beta, 1.0 - accepted)).max(floor.min(self.weight));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::drivers::negotiation::Settings;

    #[test]
    fn full_acceptance_keeps_the_weight_and_refusal_lowers_it_to_the_floor() {
        let mut concession = Concession::default();
        concession.concede(1.0, 0.8, 0.02);
        assert_eq!(concession.weight(), 0.5);
        concession.concede(0.0, 0.8, 0.02);
        assert!((concession.weight() - 0.4).abs() < 1e-15);
        (0..100).for_each(|_| concession.concede(0.0, 0.8, 0.02));
        assert_eq!(concession.weight(), 0.02);
    }

    /// The ratio of the costs' coefficients in eq. 6.14, `(w/Z₁) / ((1 − w)/Z₂)`.
    fn cost_ratio(concession: Concession, settings: &Settings) -> f64 {
        let weight = concession.weight();
        weight / settings.ego_normaliser / ((1.0 - weight) / settings.other_normaliser)
    }

    #[test]
    fn by_default_the_ego_s_cost_counts_more_at_first_and_less_after_full_concession() {
        let (mut concession, settings) = (Concession::default(), Settings::default());
        assert!((cost_ratio(concession, &settings) - 100.0).abs() < 1e-9);
        (0..100).for_each(|_| concession.concede(0.0, settings.beta, settings.least_weight()));
        assert!((cost_ratio(concession, &settings) - 0.1).abs() < 1e-12);
    }

    proptest! {
        /// Whatever the normalisers, refusals never raise the weight and end at the least ratio of the costs.
        #[test]
        fn refusals_end_at_the_least_ratio_of_the_costs(
            ego_normaliser in 0.1..10.0, other_normaliser in 0.1..1e3, least_cost_ratio in 1e-3..10.0,
        ) {
            let settings = Settings { ego_normaliser, other_normaliser, least_cost_ratio, ..Settings::default() };
            let mut concession = Concession::default();
            let first = cost_ratio(concession, &settings);
            for _ in 0..100 {
                let before = concession.weight();
                concession.concede(0.0, settings.beta, settings.least_weight());
                prop_assert!(concession.weight() <= before);
            }
            let expected = first.min(least_cost_ratio);
            prop_assert!((cost_ratio(concession, &settings) / expected - 1.0).abs() < 1e-9);
        }
    }
}
