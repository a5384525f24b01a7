//! Intervals at 95 %: the bootstrap interval of a mean, and Wilson's interval of a share.

use interplay_common::random::Random;
use rayon::prelude::*;

use super::quantile::quantile;

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
    if numbers.is_empty() {
        return None;
    }
    let count = numbers.len();
    // Each mean has its own random stream, so the result does not depend on threads.
    let resampled = |resample: u64| {
        let mut random = Random::new(SEED, stream * RESAMPLES + resample);
        let mut draw = || numbers[(random.uniform(0.0, count as f64) as usize).min(count - 1)];
        (0..count).map(|_| draw()).sum::<f64>() / count as f64
    };
    let mut means: Vec<f64> = (0..RESAMPLES).into_par_iter().map(resampled).collect();
    means.sort_by(f64::total_cmp);
    let mean = numbers.iter().sum::<f64>() / count as f64;
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
}
