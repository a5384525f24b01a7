//! Correction for multiple tests.

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

    /// `statsmodels.stats.multitest.multipletests(p, method="holm")[1]`, and the example of Holm's definition.
    #[test]
    fn the_correction_agrees_with_statsmodels() {
        let found = holm(&[0.01, 0.04, 0.03, 0.005]);
        for (found, expected) in found.iter().zip([0.03, 0.06, 0.06, 0.02]) {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
        assert_eq!(holm(&[]), Vec::<f64>::new());
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
    }
}
