//! Wilson's interval of a share.

/// The quantile of the standard normal distribution that bounds 95 % on both sides.
const NORMAL_QUANTILE_95: f64 = 1.959_963_984_540_054;

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

    /// `scipy.stats.binomtest(k, n).proportion_ci(method="wilson")` of SciPy 1.17.1.
    #[test]
    fn the_interval_agrees_with_scipy() {
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
