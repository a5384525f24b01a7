//! Intervals at 95 %: the bootstrap interval of a mean, and Wilson's interval of a share.

use interplay_common::random::Random;
use rayon::prelude::*;

const RESAMPLES: u64 = 1000;
/// Seed of all intervals: the same rows give the same intervals.
const SEED: u64 = 1;
/// The quantiles of the resampled means that bound 95 %.
const BOUNDS: [f64; 2] = [0.025, 0.975];
/// The quantile of the standard normal distribution that bounds 95 % on both sides.
const NORMAL_QUANTILE_95: f64 = 1.959_963_984_540_054;

/// The mean of numbers with its 95 % interval: quantiles of the means of equally many numbers drawn with
/// replacement (Efron's percentile bootstrap). None without numbers; `stream`, below 2⁵⁴, separates the draws of intervals.
pub(crate) fn mean_interval(numbers: &[f64], stream: u64) -> Option<(f64, [f64; 2])> {
    stratified_mean_interval(&[numbers], stream)
}

/// The mean of the means of strata, which count equally, with its 95 % interval: each resample draws as many numbers with replacement
/// from every stratum as it has. None without strata, or with an empty one.
pub fn stratified_mean_interval(strata: &[&[f64]], stream: u64) -> Option<(f64, [f64; 2])> {
    if strata.is_empty() || strata.iter().any(|numbers| numbers.is_empty()) {
        return None;
    }
    let over_strata = |mean_of: &mut dyn FnMut(&[f64]) -> f64| {
        strata.iter().map(|numbers| mean_of(numbers)).sum::<f64>() / strata.len() as f64
    };
    // Each mean has its own random stream, so the result does not depend on threads.
    let resampled = |resample: u64| {
        let mut random = Random::new(SEED, stream * RESAMPLES + resample);
        over_strata(&mut |numbers| {
            let count = numbers.len();
            let mut draw = || numbers[(random.uniform(0.0, count as f64) as usize).min(count - 1)];
            (0..count).map(|_| draw()).sum::<f64>() / count as f64
        })
    };
    let mut means: Vec<f64> = (0..RESAMPLES).into_par_iter().map(resampled).collect();
    means.sort_by(f64::total_cmp);
    let mean = over_strata(&mut |numbers| numbers.iter().sum::<f64>() / numbers.len() as f64);
    let bound = |share| quantile(&means, share).unwrap_or(mean);
    Some((mean, BOUNDS.map(bound)))
}

/// Wilson's 95 % interval of a share, `kept` of `of`; the whole unit interval if `of` is zero.
///
/// The set of all shares `p` with `|k/n − p| ≤ z √(p (1 − p)/n)`.
pub(crate) fn wilson_interval(kept: usize, of: usize) -> [f64; 2] {
    if of == 0 {
        return [0.0, 1.0];
    }
    let (share, count, z) = (kept as f64 / of as f64, of as f64, NORMAL_QUANTILE_95);
    let centre = (share + z * z / (2.0 * count)) / (1.0 + z * z / count);
    let half = z / (1.0 + z * z / count) * (share * (1.0 - share) / count + z * z / (4.0 * count * count)).sqrt();
    [(centre - half).max(0.0), (centre + half).min(1.0)]
}

/// The quantile of sorted numbers, interpolated linearly as NumPy does by default; none without any.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = share.clamp(0.0, 1.0) * last as f64;
    let below = (place.floor() as usize).min(last);
    let [low, high] = [sorted[below], sorted[(below + 1).min(last)]];
    // The difference of two infinite neighbours is undefined.
    Some(if low == high { low } else { low + (place - below as f64) * (high - low) })
}

/// The median of unsorted numbers; none without any.
pub(crate) fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    quantile(&numbers, 0.5)
}

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

    /// `scipy.stats.bootstrap((x,), numpy.mean, n_resamples=200000, method="percentile")` of SciPy 1.17.1 gives 2.47 to 4.62.
    #[test]
    fn the_bootstrap_interval_agrees_with_scipy() {
        let numbers = [2.1, 2.4, 3.0, 2.2, 8.5, 2.9, 3.3, 2.0, 2.8, 4.1];
        let (mean, [low, high]) = mean_interval(&numbers, 0).expect("numbers");
        assert!((mean - 3.33).abs() < 1e-12);
        // A quantile at 2.5 % of 1000 means has a standard error of about 0.03 below and 0.08 above.
        assert!((low - 2.47).abs() < 0.1 && (high - 4.62).abs() < 0.25, "{low} to {high}");
        assert_eq!(mean_interval(&numbers, 0), mean_interval(&numbers, 0));
        assert_eq!(mean_interval(&[], 0), None);
        assert_eq!(mean_interval(&[2.0, 2.0], 0), Some((2.0, [2.0, 2.0])));
    }

    /// Strata count equally, whatever their sizes, and differences between them do not widen the interval.
    #[test]
    fn strata_count_equally() {
        let found = stratified_mean_interval(&[&[1.0; 9], &[4.0]], 0);
        assert_eq!(found, Some((2.5, [2.5, 2.5])));
        assert_eq!(stratified_mean_interval(&[&[1.0], &[]], 0), None);
    }

    /// `scipy.stats.binomtest(k, n).proportion_ci(method="wilson")` of SciPy 1.17.1.
    #[test]
    fn the_wilson_interval_agrees_with_scipy() {
        for (kept, of, low, high) in [
            (0, 20, 0.0, 0.161_125_158_052_819_35),
            (10, 20, 0.299_298_008_198_212_4, 0.700_701_991_801_787_7),
            (19, 20, 0.763_868_806_553_258, 0.991_118_551_199_204_7),
            (194, 200, 0.936_105_707_545_480_7, 0.986_179_685_659_888_7),
            (1, 1, 0.206_549_314_377_237_45, 1.0),
        ] {
            let found = wilson_interval(kept, of);
            assert!((found[0] - low).abs() < 1e-14 && (found[1] - high).abs() < 1e-14, "{kept}/{of}: {found:?}");
        }
        assert_eq!(wilson_interval(0, 0), [0.0, 1.0]);
    }

    /// `numpy.quantile([3, 1, 4, 1, 5, 9, 2, 6], [0, 0.05, 0.5, 0.9, 1])`.
    #[test]
    fn quantiles_agree_with_numpy() {
        let sorted = [1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 9.0];
        for (share, expected) in [(0.0, 1.0), (0.05, 1.0), (0.5, 3.5), (0.9, 6.9), (1.0, 9.0)] {
            let found = quantile(&sorted, share).expect("numbers");
            assert!((found - expected).abs() < 1e-12, "{share}: {found}");
        }
        assert_eq!((quantile(&[], 0.5), quantile(&[2.0], 0.3)), (None, Some(2.0)));
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
    }

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
