//! Quantiles.

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

#[cfg(test)]
mod tests {
    use super::*;

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
}
