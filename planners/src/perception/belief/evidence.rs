//! Probabilities of hypotheses from accumulated evidence.
//!
//! Hypothesis `i` has the prior `π_i` and the evidence `L_i`, a sum of log-likelihoods. An observation with log-likelihoods `ℓ_i`
//! changes it to
//!
//! ```text
//! L_i ← f L_i + ℓ_i − ℓ̄,      ℓ̄ = ln Σ p_i exp(ℓ_i) / Σ p_i,      L_i ≥ max_j L_j + ln ε
//! p_i ∝ π_i exp(L_i)
//! ```
//!
//! with the forgetting factor `f` and the floor `ε`. Sums run over the hypotheses that were compared with the observation. Of the
//! others nothing is learnt: their evidence only fades.

/// The evidence for a list of hypotheses.
#[derive(Clone, Debug)]
pub(super) struct Evidence {
    log_priors: Vec<f64>,
    log_likelihoods: Vec<f64>,
}

impl Evidence {
    /// No evidence yet; the priors need not sum to 1.
    pub(super) fn new(priors: &[f64]) -> Evidence {
        let log_priors = priors.iter().map(|prior| libm::log(*prior)).collect();
        Evidence { log_priors, log_likelihoods: vec![0.0; priors.len()] }
    }

    /// Takes in an observation: the log-likelihood of each hypothesis, none of those that were not compared with it.
    pub(super) fn observe(&mut self, log_likelihoods: &[Option<f64>], forgetting: f64, floor: f64) {
        let probabilities = self.probabilities();
        let compared = || probabilities.iter().zip(log_likelihoods).filter_map(|(p, found)| Some((p, (*found)?)));
        let highest = compared().map(|(_, found)| found).fold(f64::NEG_INFINITY, f64::max);
        if !highest.is_finite() {
            return;
        }
        let (mass, weighted) = compared()
            .fold((0.0, 0.0), |(mass, weighted), (p, found)| (mass + p, weighted + p * libm::exp(found - highest)));
        if !(mass > 0.0 && weighted > 0.0) {
            return;
        }
        let mean = highest + libm::log(weighted / mass);
        for (evidence, found) in self.log_likelihoods.iter_mut().zip(log_likelihoods) {
            *evidence = forgetting * *evidence + found.map_or(0.0, |found| found - mean);
        }
        let most = self.log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = most + libm::log(floor);
        self.log_likelihoods.iter_mut().for_each(|evidence| *evidence = evidence.max(least));
    }

    /// The probabilities of the hypotheses; they sum to 1.
    pub(super) fn probabilities(&self) -> Vec<f64> {
        let logs = || self.log_priors.iter().zip(&self.log_likelihoods).map(|(prior, evidence)| prior + evidence);
        let highest = logs().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = logs().map(|log| libm::exp(log - highest)).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter().map(|weight| weight / sum).collect()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn without_forgetting_it_is_bayes_rule() {
        let mut evidence = Evidence::new(&[0.2, 0.8]);
        for (a, b) in [(-1.0_f64, -0.2_f64), (-0.3, -0.9)] {
            evidence.observe(&[Some(a), Some(b)], 1.0, 1e-9);
        }
        let odds = 0.2 / 0.8 * (-1.3_f64 + 1.1).exp();
        let found = evidence.probabilities();
        assert!((found[0] / found[1] - odds).abs() < 1e-12);
    }

    #[test]
    fn of_what_is_not_compared_the_probability_stays() {
        let mut evidence = Evidence::new(&[0.5, 0.2, 0.3]);
        evidence.observe(&[Some(-3.0), None, Some(-1.0)], 1.0, 1e-9);
        let found = evidence.probabilities();
        assert!((found[1] - 0.2).abs() < 1e-12, "{found:?}");
        assert!(found[2] > 0.5);
    }

    #[test]
    fn what_is_forgotten_returns_to_the_prior() {
        let mut evidence = Evidence::new(&[0.3, 0.7]);
        evidence.observe(&[Some(0.0), Some(-5.0)], 0.9, 1e-9);
        (0..200).for_each(|_| evidence.observe(&[Some(-1.0), Some(-1.0)], 0.9, 1e-9));
        assert!((evidence.probabilities()[0] - 0.3).abs() < 1e-6);
    }

    proptest! {
        /// However long a hypothesis was wrong, a few observations bring it back.
        #[test]
        fn no_hypothesis_is_ever_excluded(wrong in 1_usize..500, surprise in 1.0_f64..50.0) {
            let mut evidence = Evidence::new(&[0.5, 0.5]);
            (0..wrong).for_each(|_| evidence.observe(&[Some(-surprise), Some(0.0)], 0.98, 1e-3));
            let low = evidence.probabilities()[0];
            prop_assert!(low >= 0.99e-3, "{}", low);
            let needed = (14.0 / surprise).ceil() as usize + 1;
            (0..needed).for_each(|_| evidence.observe(&[Some(0.0), Some(-surprise)], 0.98, 1e-3));
            prop_assert!(evidence.probabilities()[0] > 0.5);
        }
    }
}
