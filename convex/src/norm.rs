//! Inner product and norms. If an entry is NaN, the result is NaN.

/// aᵀb.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// ‖v‖₂.
pub(crate) fn euclidean(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// ‖v‖∞.
pub(crate) fn magnitude(vector: &[f64]) -> f64 {
    largest(vector.iter().map(|v| v.abs()))
}

/// The largest of `values` and zero; NaN if one of them is NaN (`f64::max` would ignore it).
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |largest, v| if v > largest || v.is_nan() { v } else { largest })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_of_vectors_with_nan_are_nan() {
        assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
        assert!(magnitude(&[f64::NAN, 3.0]).is_nan());
        assert!(euclidean(&[3.0, f64::NAN]).is_nan());
        assert_eq!(magnitude(&[-3.0, 2.0]), 3.0);
    }
}
