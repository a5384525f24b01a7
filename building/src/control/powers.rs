//! The spectral radius and the largest singular value of a linear map, from its products with vectors: for maps that
//! are too large to store.

use crate::staged::dense::dot;

const MAX_PRODUCTS: usize = 600;
/// A singular value is found when it changes by no more than this share from one product to the next.
const SINGULAR_VALUE_TOLERANCE: f64 = 1e-9;

/// ‖M‖₂ by the power method on MᵀM, to six digits, or a thousandth where several are nearly as large. `product` is M x,
/// `transpose_product` Mᵀ y.
pub(super) fn largest_singular_value(
    size: usize,
    product: impl Fn(&[f64]) -> Vec<f64>,
    transpose_product: impl Fn(&[f64]) -> Vec<f64>,
) -> f64 {
    let mut x = any_direction(size);
    let mut value = 0.0;
    for _ in 0..MAX_PRODUCTS / 2 {
        let length = norm(&x);
        if length == 0.0 {
            return 0.0;
        }
        x.iter_mut().for_each(|x| *x /= length);
        let image = product(&x);
        let before = std::mem::replace(&mut value, norm(&image));
        if (value - before).abs() <= SINGULAR_VALUE_TOLERANCE * value {
            break;
        }
        x = transpose_product(&image);
    }
    value
}

/// ρ(M), the mean growth of ‖Mᵏx‖ over the later half of the products. Where several eigenvalues are nearly as large as the
/// largest, or complex, it is right to about a hundredth.
pub(super) fn spectral_radius(size: usize, product: impl Fn(&[f64]) -> Vec<f64>) -> f64 {
    let mut x = any_direction(size);
    let mut logarithm = 0.0;
    for count in 0..MAX_PRODUCTS {
        let length = norm(&x);
        if length == 0.0 || !length.is_finite() {
            return if length == 0.0 { 0.0 } else { f64::NAN };
        }
        if count > MAX_PRODUCTS / 2 {
            logarithm += libm::log(length);
        }
        x.iter_mut().for_each(|x| *x /= length);
        x = product(&x);
    }
    libm::exp(logarithm / (MAX_PRODUCTS / 2 - 1) as f64)
}

/// A direction that no eigenvector is orthogonal to, unless by accident.
fn any_direction(size: usize) -> Vec<f64> {
    (0..size).map(|i| 1.0 + libm::sin(i as f64)).collect()
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norm_and_spectral_radius_of_a_2_by_2_map_match_their_closed_forms() {
        // [[0.5, 3], [0, 0.8]]: eigenvalues 0.5 and 0.8; σ² the larger root of z² − 9.89 z + 0.16.
        let product = |x: &[f64]| vec![0.5 * x[0] + 3.0 * x[1], 0.8 * x[1]];
        let transpose = |y: &[f64]| vec![0.5 * y[0], 3.0 * y[0] + 0.8 * y[1]];
        let sigma = (0.5 * (9.89 + (9.89_f64 * 9.89 - 0.64).sqrt())).sqrt();
        assert!((largest_singular_value(2, product, transpose) - sigma).abs() < 1e-6 * sigma);
        assert!((spectral_radius(2, product) - 0.8).abs() < 1e-9);
        // A quarter of a turn, shrunk: two complex eigenvalues of magnitude 0.9.
        assert!((spectral_radius(2, |x| vec![-0.9 * x[1], 0.9 * x[0]]) - 0.9).abs() < 1e-9);
        assert_eq!(spectral_radius(2, |_| vec![0.0; 2]), 0.0);
    }
}
