//! Gauss-Legendre quadrature with ten points.

/// Positive nodes on `[−1, 1]` with their weights (Abramowitz and Stegun, table 25.4).
const RULE: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Integral of a function with `N` values over `[from, to]`; exact for polynomials up to degree 19.
pub(super) fn integrate<const N: usize>(from: f64, to: f64, function: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = [0.0; N];
    for (node, weight) in RULE {
        let (before, after) = (function(middle - half * node), function(middle + half * node));
        for i in 0..N {
            sum[i] += weight * (before[i] + after[i]);
        }
    }
    sum.map(|sum| half * sum)
}

#[cfg(test)]
mod tests {
    use super::integrate;

    #[test]
    fn quadrature_is_exact_for_polynomials_of_degree_19() {
        let [nineteenth, second] = integrate(0.0, 2.0, |x| [20.0 * x.powi(19), 3.0 * x * x]);
        assert!((nineteenth / 2.0_f64.powi(20) - 1.0).abs() < 1e-14 && (second - 8.0).abs() < 1e-14);
    }
}
