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
    let scaled = matrix.map(|entry| entry * scale);
    let size = matrix.nrows();
    let identity = DMatrix::from_fn(size, size, |i, j| real(f64::from(u8::from(i == j))));
    // Horner's scheme: I + M (I + M/2 (I + M/3 (…))).
    let mut sum = identity.clone();
    for term in (1..=TAYLOR_TERMS).rev() {
        sum = &identity + product(&scaled, &sum).map(|entry| entry / f64::from(term));
    }
    for _ in 0..squarings {
        sum = product(&sum, &sum);
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// exp of a rotation is cosine and sine, and its derivative over the angle is the rotation's own.
    #[test]
    fn a_rotation_and_its_derivative() {
        for angle in [0.01, 0.7, 3.0, 40.0] {
            let turn = Number::new(angle, INFINITESIMAL);
            let generator = DMatrix::from_row_slice(2, 2, &[real(0.0), -turn, turn, real(0.0)]);
            let rotation = matrix_exponential(&generator).expect("finite");
            assert!((rotation[(0, 0)].re - libm::cos(angle)).abs() < 1e-12, "{angle}");
            assert!((rotation[(1, 0)].im / INFINITESIMAL - libm::cos(angle)).abs() < 1e-12, "{angle}");
        }
        assert!(matrix_exponential(&DMatrix::from_element(1, 1, real(f64::NAN))).is_none());
    }
}
