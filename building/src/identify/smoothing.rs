//! Kernel smoothing: the conditional expectations of eq. 2.5.
//!
//! At each time t the smoother fits a straight line to its neighbours, weighted by a Gaussian kernel of bandwidth h,
//!
//! ```text
//! min over α, β of  Σ_s exp(−½ ((s − t)/h)²) (x_s − α − β (s − t))²,    x̂_t = α
//! ```
//!
//! A local *line*, unlike a local mean, is unbiased for trends, also at the ends of the data.

/// Distance from its centre at which the kernel is cut off, in bandwidths; its weight there is exp(−8) = 3·10⁻⁴ of that at the
/// centre.
const CUTOFF_BANDWIDTHS: f64 = 4.0;

/// The series minus its local-linear kernel smooth; `bandwidth` in samples.
///
/// A constant and a straight line leave nothing. Fewer than three samples leave zeros.
pub(super) fn without_smooth(series: &[f64], bandwidth: f64) -> Vec<f64> {
    local_linear(series, bandwidth).iter().zip(series).map(|(smooth, value)| value - smooth).collect()
}

/// The local-linear kernel smooth of a series; `bandwidth` in samples.
fn local_linear(series: &[f64], bandwidth: f64) -> Vec<f64> {
    if series.len() < 3 {
        return series.to_vec();
    }
    // A line needs two neighbours on each side, even at the smallest bandwidth.
    let reach = libm::ceil(CUTOFF_BANDWIDTHS * bandwidth).clamp(2.0, series.len() as f64) as usize;
    let weights: Vec<f64> = (0..=reach)
        .map(|distance| {
            let scaled = distance as f64 / bandwidth;
            libm::exp(-0.5 * scaled * scaled)
        })
        .collect();
    (0..series.len()).map(|centre| line_at(series, centre, &weights)).collect()
}

/// The weighted line through the neighbours of `centre`, there.
fn line_at(series: &[f64], centre: usize, weights: &[f64]) -> f64 {
    let reach = weights.len() - 1;
    let (first, last) = (centre.saturating_sub(reach), (centre + reach).min(series.len() - 1));
    // Moments of the distances, and of the values relative to that of the centre.
    let (mut s0, mut s1, mut s2, mut m0, mut m1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for index in first..=last {
        let weight = weights[index.abs_diff(centre)];
        let distance = index as f64 - centre as f64;
        let value = series[index] - series[centre];
        s0 += weight;
        s1 += weight * distance;
        s2 += weight * distance * distance;
        m0 += weight * value;
        m1 += weight * distance * value;
    }
    let determinant = s0 * s2 - s1 * s1;
    // If almost all weight is at the centre, the smoothed value is the value itself.
    if determinant <= 1e-12 * s0 * s0 { series[centre] } else { series[centre] + (s2 * m0 - s1 * m1) / determinant }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{local_linear, without_smooth};

    proptest! {
        #[test]
        fn the_smoother_reproduces_straight_lines(start in -50.0..50.0, slope in -2.0..2.0, length in 3_usize..200, bandwidth in 0.6..30.0) {
            let line: Vec<f64> = (0..length).map(|t| start + slope * t as f64).collect();
            for rest in without_smooth(&line, bandwidth) {
                prop_assert!(rest.abs() < 1e-9, "{rest}");
            }
        }

        #[test]
        fn smoothing_is_linear_in_the_series(a in prop::collection::vec(-5.0..5.0, 40), b in prop::collection::vec(-5.0..5.0, 40), c in -3.0..3.0) {
            let both: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + c * b).collect();
            let (sa, sb) = (local_linear(&a, 4.0), local_linear(&b, 4.0));
            for (t, smooth) in local_linear(&both, 4.0).iter().enumerate() {
                let error: f64 = smooth - sa[t] - c * sb[t];
                prop_assert!(error.abs() < 1e-9);
            }
        }
    }

    /// The definition, solved afresh at each point by 2×2 normal equations without cut-off.
    #[test]
    fn the_smoother_is_the_weighted_least_squares_line() {
        let series: Vec<f64> = (0..60).map(|t| f64::from((t * 37) % 11) + 0.1 * f64::from(t)).collect();
        let bandwidth = 5.0;
        for (centre, smooth) in local_linear(&series, bandwidth).iter().enumerate() {
            let mut normal = [[0.0; 2]; 2];
            let mut moment = [0.0; 2];
            for (index, value) in series.iter().enumerate() {
                let d = index as f64 - centre as f64;
                let weight = (-0.5 * (d / bandwidth).powi(2)).exp();
                for (row, left) in [1.0, d].into_iter().enumerate() {
                    moment[row] += weight * left * value;
                    normal[row][0] += weight * left;
                    normal[row][1] += weight * left * d;
                }
            }
            let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
            let exact = (normal[1][1] * moment[0] - normal[0][1] * moment[1]) / determinant;
            assert!((smooth - exact).abs() < 0.02, "at {centre}: {smooth} against {exact}");
        }
    }
}
