//! Matrix exponentials, by arithmetic alone, so that the bits are the same on every processor.

use nalgebra::{Complex, DMatrix};

/// A number with an infinitesimal part. A derivative is the imaginary part of a result, divided by that of the argument
/// (complex-step differentiation: Squire and Trapp, SIAM Review 40, 1998). Without an imaginary part it is an ordinary number.
pub(super) type Number = Complex<f64>;

/// The imaginary part that stands for an infinitesimal change: its square is far below the rounding errors of every real part.
pub(super) const INFINITESIMAL: f64 = 1e-100;

/// Terms of the Taylor series. With a norm of at most a half, the first one that is left out is below 1e-22.
const TAYLOR_TERMS: u32 = 17;
const MAX_NORM: f64 = 0.5;
/// Norm beyond which no exponential is formed: it could not be scaled down.
const LARGEST_NORM: f64 = 1e12;

/// A number without an infinitesimal part.
pub(super) fn real(value: f64) -> Number {
    Number::new(value, 0.0)
}

/// eˣ, to the first order in the infinitesimal part.
pub(super) fn exponential(x: Number) -> Number {
    let value = libm::exp(x.re);
    Number::new(value, value * x.im)
}

/// The product of two matrices, summed in the order of the columns of `a`.
///
/// The library's own product chooses its instructions by the processor.
pub(super) fn product(a: &DMatrix<Number>, b: &DMatrix<Number>) -> DMatrix<Number> {
    DMatrix::from_fn(a.nrows(), b.ncols(), |i, j| (0..a.ncols()).fold(real(0.0), |sum, k| sum + a[(i, k)] * b[(k, j)]))
}

/// exp(M) by scaling and squaring; `None` if an entry of M is not finite or far too large.
pub(super) fn matrix_exponential(matrix: &DMatrix<Number>) -> Option<DMatrix<Number>> {
    let (scaled, squarings) = scaled(matrix)?;
    let mut sum = taylor(&scaled, 0);
    for _ in 0..squarings {
        sum = product(&sum, &sum);
    }
    Some(sum)
}

/// φ₀(M) = exp(M), φ₁(M) = Σ Mᵏ/(k+1)! and φ₂(M) = Σ Mᵏ/(k+2)!; `None` as for [`matrix_exponential`].
///
/// They are doubled by φ₁(2M) = ½ (φ₀ φ₁ + φ₁) and φ₂(2M) = ¼ (φ₀ φ₂ + φ₁ + φ₂) (Skaflestad and Wright, *Applied Numerical Mathematics* 59, 2009).
pub(super) fn phi_functions(matrix: &DMatrix<Number>) -> Option<[DMatrix<Number>; 3]> {
    let (scaled, squarings) = scaled(matrix)?;
    let [mut exponential, mut first, mut second] = [0, 1, 2].map(|order| taylor(&scaled, order));
    for _ in 0..squarings {
        second = (product(&exponential, &second) + &first + &second).map(|entry| entry * 0.25);
        first = (product(&exponential, &first) + &first).map(|entry| entry * 0.5);
        exponential = product(&exponential, &exponential);
    }
    Some([exponential, first, second])
}

/// M over a power of two so that its norm is at most a half, and the exponent of that power.
fn scaled(matrix: &DMatrix<Number>) -> Option<(DMatrix<Number>, u32)> {
    let row_sum = |row: usize| (0..matrix.ncols()).map(|column| matrix[(row, column)].re.abs()).sum::<f64>();
    let norm = (0..matrix.nrows()).map(row_sum).fold(0.0, f64::max);
    if norm >= LARGEST_NORM || matrix.iter().any(|entry| !entry.re.is_finite()) {
        return None;
    }
    let (mut scale, mut squarings) = (1.0, 0);
    while norm * scale > MAX_NORM {
        scale *= 0.5;
        squarings += 1;
    }
    Some((matrix.map(|entry| entry * scale), squarings))
}

/// Σ Mᵏ/(k + order)! by Horner's scheme: I + M (I + M/2 (I + M/3 (…))) for order 0.
fn taylor(matrix: &DMatrix<Number>, order: u32) -> DMatrix<Number> {
    let size = matrix.nrows();
    let scalar = |value: f64| DMatrix::from_fn(size, size, |i, j| real(if i == j { value } else { 0.0 }));
    let factorial: u32 = (1..=order).product();
    let first = 1.0 / f64::from(factorial);
    let mut sum = scalar(first);
    for term in (1..=TAYLOR_TERMS).rev() {
        // The scheme includes (k + order)!/order! in its quotients, and 1/order! in its sums.
        sum = product(matrix, &sum).map(|entry| entry / f64::from(term + order));
        (0..size).for_each(|i| sum[(i, i)] += first);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// exp of a rotation is cosine and sine, and its derivative over the angle is the rotation's own.
    #[test]
    fn the_exponential_of_a_rotation_and_its_derivative_are_exact() {
        for angle in [0.01, 0.7, 3.0, 40.0] {
            let turn = Number::new(angle, INFINITESIMAL);
            let generator = DMatrix::from_row_slice(2, 2, &[real(0.0), -turn, turn, real(0.0)]);
            let rotation = matrix_exponential(&generator).expect("finite");
            assert!((rotation[(0, 0)].re - libm::cos(angle)).abs() < 1e-12, "{angle}");
            assert!((rotation[(1, 0)].im / INFINITESIMAL - libm::cos(angle)).abs() < 1e-12, "{angle}");
        }
        assert!(matrix_exponential(&DMatrix::from_element(1, 1, real(f64::NAN))).is_none());
    }

    /// M φ₁(M) = exp(M) − I and M φ₂(M) = φ₁(M) − I, small or large.
    #[test]
    fn phi_functions_obey_their_recursion() {
        for size in [0.01, 1.0, 30.0] {
            let matrix = DMatrix::from_row_slice(2, 2, &[-2.0, 1.0, 0.5, -0.7].map(|entry| real(size * entry)));
            let [exponential, first, second] = phi_functions(&matrix).expect("finite");
            let identity = DMatrix::from_diagonal_element(2, 2, real(1.0));
            let close = |one: DMatrix<Number>, other: DMatrix<Number>| {
                let error = (one - other).iter().fold(0.0_f64, |error, entry| error.max(entry.norm()));
                assert!(error < 1e-13, "{size}: {error}");
            };
            close(product(&matrix, &first), &exponential - &identity);
            close(product(&matrix, &second), &first - &identity);
            close(matrix_exponential(&matrix).expect("finite"), exponential);
        }
    }
}
