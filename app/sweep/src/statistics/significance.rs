//! Significance: the sign test of a split of unequal pairs, and the correction for multiple tests.

/// The probability of a split of the unequal pairs at least as uneven if both outcomes were equally likely: McNemar's exact test, which
/// is the two-sided sign test. 1 without unequal pairs.
///
/// `2 Σ_{k ≤ min} C(n, k) 2⁻ⁿ`, summed from its largest term downwards; only that term needs a logarithm, so no power underflows,
/// for any number of pairs.
pub(crate) fn sign_test(wins: usize, losses: usize) -> f64 {
    let (of, least) = ((wins + losses) as f64, wins.min(losses));
    let ln_choose = libm::lgamma(of + 1.0) - libm::lgamma(least as f64 + 1.0) - libm::lgamma(of - least as f64 + 1.0);
    let largest = libm::exp(ln_choose - of * std::f64::consts::LN_2);
    let (mut term, mut sum) = (1.0, 0.0);
    for count in (0..=least).rev() {
        sum += term;
        term *= count as f64 / (of - count as f64 + 1.0);
    }
    (2.0 * largest * sum).min(1.0)
}

/// Holm's correction: adjusts each probability so that the chance of any false alarm among all tests is at most
/// the level. The `i`-th smallest of `m` is multiplied by `m − i + 1`, and none may be below a smaller one.
pub(crate) fn holm(probabilities: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..probabilities.len()).collect();
    order.sort_by(|a, b| probabilities[*a].total_cmp(&probabilities[*b]));
    let (mut corrected, mut last) = (vec![1.0; probabilities.len()], 0.0_f64);
    for (rank, index) in order.into_iter().enumerate() {
        last = last.max((probabilities[index] * (probabilities.len() - rank) as f64).min(1.0));
        corrected[index] = last;
    }
    corrected
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `scipy.stats.binomtest(wins, wins + losses).pvalue` of SciPy 1.17.1.
    #[test]
    fn the_sign_test_probability_agrees_with_scipy() {
        for (wins, losses, expected) in [
            (0, 194, 7.965_459_555_662_261e-59),
            (5, 7, 0.774_414_062_5),
            (23, 1, 2.980_232_238_769_531_2e-6),
            (1, 0, 1.0),
            (700, 900, 6.319_484_959_450_105e-7),
            (3000, 3200, 0.011_488_253_770_871_584),
        ] {
            for found in [sign_test(wins, losses), sign_test(losses, wins)] {
                assert!((found / expected - 1.0).abs() < 1e-9, "{wins} to {losses}: {found:e}");
            }
        }
        assert_eq!((sign_test(0, 0), sign_test(4, 4)), (1.0, 1.0));
    }

    /// `2^(1 − n)` where all pairs go one way.
    #[test]
    fn the_sign_test_of_a_one_sided_split_has_a_closed_form() {
        assert!((sign_test(10, 0) / 0.5_f64.powi(9) - 1.0).abs() < 1e-12);
        assert!(sign_test(2000, 0) == 0.0 && sign_test(1000, 0) > 0.0);
    }

    /// `statsmodels.stats.multitest.multipletests(p, method="holm")[1]`, and the example of Holm's definition.
    #[test]
    fn holms_correction_agrees_with_statsmodels() {
        let found = holm(&[0.01, 0.04, 0.03, 0.005]);
        for (found, expected) in found.iter().zip([0.03, 0.06, 0.06, 0.02]) {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
        assert_eq!(holm(&[]), Vec::<f64>::new());
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
    }
}
