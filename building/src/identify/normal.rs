//! The log-likelihood of the parameters is quadratic (eq. 2.8), and one Newton step finds its maximum (eq. 2.9).
//!
//! ```text
//! l(θ) = −½ Σ_t (y_t − x_tᵀθ)²,    ∇l = Xᵀy − XᵀXθ,    H = −XᵀX
//! θ ← θ − H⁻¹ ∇l(θ)
//! ```
//!
//! From any θ the step ends at least squares. The printed Hessian (2.10) lacks the minus sign of B_c and the square in C_c;
//! with it the iteration diverges. Heat flows from warm to cold, so all coefficients are at least zero, and the maximum under
//! that condition is non-negative least squares (Lawson and Hanson's active set).
//!
//! Columns are scaled to length one: coefficients differ by orders of magnitude, so that the condition number depends on
//! the data and not on the units.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, SymmetricEigen};

use super::regression::Regression;
use crate::staged::dense::dot;

/// Smallest eigenvalue of a Gram matrix with unit diagonal, as a share of the largest, that is not treated as zero: about 450
/// rounding units, above the rounding errors of the sums in its entries.
const MIN_EIGENVALUE_RATIO: f64 = 1e-13;

/// The log-likelihood of a linear regression with unit variance, up to a constant.
pub(super) struct LogLikelihood {
    /// XᵀX of the scaled columns.
    gram: DMatrix<f64>,
    /// Xᵀy of the scaled columns.
    moment: DVector<f64>,
    /// The inverse of each column's length.
    scale: Vec<f64>,
}

impl LogLikelihood {
    /// The likelihood of `regression`.
    pub fn new(regression: &Regression) -> Self {
        let columns = &regression.columns;
        let scale: Vec<f64> = columns.iter().map(|column| inverse_length(column)).collect();
        let moment = DVector::from_fn(columns.len(), |i, _| dot(&columns[i], &regression.target) * scale[i]);
        Self { gram: scaled_gram(columns, &scale), moment, scale }
    }

    /// One Newton step from `coefficients`, to the maximum over those of them that are `free`; the others become zero.
    ///
    /// Where the Hessian is singular, the step is the shortest of those that lead to the maximum.
    pub fn newton_step(&self, coefficients: &[f64], free: &[usize]) -> Vec<f64> {
        let curvature = select(&self.gram, free);
        let start = DVector::from_fn(free.len(), |i, _| scaled(coefficients[free[i]], self.scale[free[i]]));
        let gradient = DVector::from_fn(free.len(), |i, _| self.moment[free[i]]) - &curvature * &start;
        let maximum = start + PseudoInverse::new(&curvature).matrix * &gradient;
        let mut all = vec![0.0; coefficients.len()];
        for (&index, value) in free.iter().zip(&maximum) {
            all[index] = value * self.scale[index];
        }
        all
    }

    pub fn maximum(&self) -> Vec<f64> {
        let all: Vec<usize> = (0..self.scale.len()).collect();
        self.newton_step(&vec![0.0; all.len()], &all)
    }

    /// The maximum under the condition that no coefficient is negative.
    pub fn non_negative_maximum(&self) -> Vec<f64> {
        let count = self.scale.len();
        let mut free: Vec<usize> = Vec::new();
        let mut current = vec![0.0; count];
        // Each round frees the coefficient that improves the likelihood most. The method terminates by itself; the
        // limit guards against rounding.
        for _ in 0..3 * count {
            let gradient = self.gradient(&current);
            let held = (0..count).filter(|index| !free.contains(index));
            let Some(best) = held.max_by(|&a, &b| gradient[a].total_cmp(&gradient[b])) else { break };
            if gradient[best] <= 1e-10 * self.moment.amax() {
                break;
            }
            free.push(best);
            current = self.towards_maximum(current, &mut free);
        }
        current
    }

    /// Goes to the maximum over `free`, holding at zero, and no longer free, what would become negative on the way.
    fn towards_maximum(&self, mut current: Vec<f64>, free: &mut Vec<usize>) -> Vec<f64> {
        loop {
            let target = self.newton_step(&current, free);
            // The largest step towards the target that keeps every coefficient at least zero, and the coefficient that
            // reaches zero first.
            let fraction = |i: usize| current[i] / (current[i] - target[i]);
            let negative = free.iter().copied().filter(|&i| target[i] < 0.0);
            let Some(first) = negative.min_by(|&a, &b| fraction(a).total_cmp(&fraction(b))) else {
                return target;
            };
            let fraction = fraction(first);
            for &i in free.iter() {
                current[i] = (current[i] + fraction * (target[i] - current[i])).max(0.0);
            }
            current[first] = 0.0;
            free.retain(|&i| i != first);
        }
    }

    /// ∇l with respect to the scaled coefficients.
    fn gradient(&self, coefficients: &[f64]) -> DVector<f64> {
        let scaled = DVector::from_fn(coefficients.len(), |i, _| scaled(coefficients[i], self.scale[i]));
        // Unlike a product of matrices, a product with a vector rounds in the same way on every processor.
        &self.moment - &self.gram * scaled
    }
}

/// Covariance of least-squares coefficients when residuals are correlated over time and differ in size (Newey and West):
///
/// ```text
/// (XᵀX)⁻¹ S (XᵀX)⁻¹,    S = Σ_|l|≤L (1 − |l|/(L+1)) Σ_t e_t x_t x_{t−l}ᵀ e_{t−l}
/// ```
///
/// The variance of a coefficient that the data do not determine is infinite.
pub(super) fn robust_covariance(
    columns: &[Vec<f64>],
    residuals: &[f64],
    segments: &[Range<usize>],
    lags: usize,
) -> DMatrix<f64> {
    let count = columns.len();
    let scale: Vec<f64> = columns.iter().map(|column| inverse_length(column)).collect();
    let inverse = PseudoInverse::new(&scaled_gram(columns, &scale));
    let scores: Vec<Vec<f64>> = (columns.iter().zip(&scale))
        .map(|(column, scale)| column.iter().zip(residuals).map(|(value, rest)| value * rest * scale).collect())
        .collect();
    let mut middle = DMatrix::zeros(count, count);
    for lag in 0..=lags {
        let weight = 1.0 - lag as f64 / (lags as f64 + 1.0);
        let lagged = DMatrix::from_fn(count, count, |i, j| lagged_product(segments, &scores[i], &scores[j], lag));
        middle += if lag == 0 { lagged } else { (&lagged + lagged.transpose()) * weight };
    }
    let covariance = product(&product(&inverse.matrix, &middle), &inverse.matrix);
    let entry =
        |i, j| if i == j && inverse.undetermined[i] { f64::INFINITY } else { covariance[(i, j)] * scale[i] * scale[j] };
    DMatrix::from_fn(count, count, entry)
}

/// Σ_t a_t b_{t−lag} within segments.
fn lagged_product(segments: &[Range<usize>], a: &[f64], b: &[f64], lag: usize) -> f64 {
    let long_enough = segments.iter().filter(|segment| segment.len() > lag);
    long_enough.map(|segment| dot(&a[segment.start + lag..segment.end], &b[segment.start..segment.end - lag])).sum()
}

/// The inverse of a symmetric matrix with unit diagonal where it has one.
struct PseudoInverse {
    /// The inverse over the directions with an eigenvalue above rounding level.
    matrix: DMatrix<f64>,
    /// Whether a coefficient has a part in one of the other directions.
    undetermined: Vec<bool>,
}

impl PseudoInverse {
    fn new(symmetric: &DMatrix<f64>) -> Self {
        let count = symmetric.nrows();
        let eigen = SymmetricEigen::new(symmetric.clone());
        let threshold = MIN_EIGENVALUE_RATIO * eigen.eigenvalues.max();
        let (mut matrix, mut undetermined) = (DMatrix::zeros(count, count), vec![false; count]);
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > threshold {
                matrix += DMatrix::from_fn(count, count, |i, j| vector[i] * vector[j] / value);
            } else {
                undetermined.iter_mut().zip(&vector).for_each(|(mark, part)| *mark |= part.abs() > 1e-3);
            }
        }
        Self { matrix, undetermined }
    }
}

/// The Cholesky factor of a symmetric matrix with unit diagonal; `None` when it is singular to working precision.
pub(super) fn positive_definite(matrix: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let factor = Cholesky::new(matrix)?;
    let pivots = factor.l_dirty().diagonal();
    (pivots.iter().all(|pivot| *pivot * *pivot > MIN_EIGENVALUE_RATIO)).then_some(factor)
}

/// The rows and columns `indices` of a symmetric matrix.
fn select(matrix: &DMatrix<f64>, indices: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(indices.len(), indices.len(), |i, j| matrix[(indices[i], indices[j])])
}

/// One over the length of a column; zero for a column of zeros.
fn inverse_length(column: &[f64]) -> f64 {
    let length = dot(column, column).sqrt();
    if length > 0.0 { 1.0 / length } else { 0.0 }
}

/// A coefficient of the scaled column.
fn scaled(coefficient: f64, scale: f64) -> f64 {
    if scale > 0.0 { coefficient / scale } else { 0.0 }
}

/// XᵀX of scaled columns.
fn scaled_gram(columns: &[Vec<f64>], scale: &[f64]) -> DMatrix<f64> {
    let mut gram = DMatrix::zeros(columns.len(), columns.len());
    for i in 0..columns.len() {
        for j in 0..=i {
            gram[(i, j)] = dot(&columns[i], &columns[j]) * scale[i] * scale[j];
            gram[(j, i)] = gram[(i, j)];
        }
    }
    gram
}

/// A matrix product. The library's own takes other instructions, with other rounding, where the processor has them.
pub(super) fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(a.nrows(), b.ncols(), |i, j| (0..a.ncols()).map(|k| a[(i, k)] * b[(k, j)]).sum())
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::{LogLikelihood, robust_covariance};
    use crate::identify::regression::Regression;
    use crate::staged::dense::dot;

    fn regression(columns: Vec<Vec<f64>>, target: Vec<f64>) -> Regression {
        let rows = target.len();
        Regression { columns, target, segments: std::iter::once(0..rows).collect(), rows: (0..rows).collect() }
    }

    /// ∇l of the unscaled problem.
    fn gradient(problem: &Regression, coefficients: &[f64]) -> Vec<f64> {
        let rest = problem.residuals(coefficients);
        problem.columns.iter().map(|column| dot(column, &rest)).collect()
    }

    fn data(rows: usize, columns: usize) -> impl Strategy<Value = Regression> {
        let column = prop::collection::vec(-1.0..1.0, rows);
        (prop::collection::vec(column.clone(), columns), column).prop_map(|(mut columns, target)| {
            // Units apart.
            columns[0].iter_mut().for_each(|value: &mut f64| *value *= 1e4);
            regression(columns, target)
        })
    }

    proptest! {
        #[test]
        fn one_newton_step_from_anywhere_ends_where_the_gradient_vanishes(problem in data(30, 3), start in prop::collection::vec(-9.0..9.0, 3)) {
            let likelihood = LogLikelihood::new(&problem);
            let end = likelihood.newton_step(&start, &[0, 1, 2]);
            for (column, slope) in problem.columns.iter().zip(gradient(&problem, &end)) {
                // Relative to the numbers that the start brings in.
                prop_assert!(slope.abs() <= 1e-6 * column.iter().fold(1.0, |most: f64, value| most.max(value.abs())));
            }
        }

        /// Karush, Kuhn and Tucker: no coefficient is negative, no slope is upwards, and one of the two is zero.
        #[test]
        fn non_negative_least_squares_is_optimal(problem in data(25, 5)) {
            let best = LogLikelihood::new(&problem).non_negative_maximum();
            for (index, slope) in gradient(&problem, &best).into_iter().enumerate() {
                let size = problem.columns[index].iter().fold(1.0, |most: f64, value| most.max(value.abs()));
                prop_assert!(best[index] >= 0.0 && slope <= 1e-8 * size);
                prop_assert!(best[index] == 0.0 || slope.abs() <= 1e-8 * size);
            }
        }
    }

    /// The printed Hessian: with B_c lacking its minus sign one step no longer suffices; with C_c lacking the square, the mean
    /// of what a smoother has left of u (about zero) stands for its variance, and the iteration diverges.
    #[test]
    fn the_printed_hessian_diverges() {
        let columns: Vec<Vec<f64>> = [(3, 7), (5, 11), (2, 13)]
            .map(|(a, b)| (0..200).map(|t| f64::from((t * a) % b) / f64::from(b) - 0.46).collect())
            .into();
        let target: Vec<f64> = (0..200)
            .map(|t| 0.3 * columns[0][t] + 0.2 * columns[1][t] + 0.9 * columns[2][t] + 0.05 * ((t % 3) as f64 - 1.0))
            .collect();
        let problem = regression(columns, target);
        let exact = LogLikelihood::new(&problem).maximum();
        let gram = DMatrix::from_fn(3, 3, |i, j| dot(&problem.columns[i], &problem.columns[j]));
        let distance_after = |hessian: &DMatrix<f64>, steps: usize| {
            let inverse = hessian.clone().try_inverse().expect("regular");
            let mut theta = DVector::zeros(3);
            for _ in 0..steps {
                theta -= &inverse * DVector::from_vec(gradient(&problem, theta.as_slice()));
            }
            (theta - DVector::from_column_slice(&exact)).norm()
        };
        let corrected = -&gram;
        assert!(distance_after(&corrected, 1) < 1e-12);
        let mut printed = corrected.clone();
        printed[(2, 2)] = -problem.columns[2].iter().sum::<f64>();
        assert!(distance_after(&printed, 40) > 1e6 * distance_after(&printed, 1));
        let mut no_sign = corrected;
        for i in 0..2 {
            no_sign[(i, 2)] = gram[(i, 2)];
            no_sign[(2, i)] = gram[(i, 2)];
        }
        assert!(distance_after(&no_sign, 1) > 1e-3);
    }

    #[test]
    fn robust_errors_match_least_squares_for_white_residuals_and_are_infinite_for_constant_regressors() {
        let column: Vec<f64> = (0..400).map(|t| f64::from((t * 37) % 41) / 41.0 - 0.5).collect();
        let residuals: Vec<f64> = (0..400).map(|t| if (t / 2) % 2 == 0 { 0.1 } else { -0.1 }).collect();
        let columns = vec![column.clone(), vec![0.0; 400]];
        let found = robust_covariance(&columns, &residuals, &[0..200, 200..400], 0);
        let usual = 0.01 / dot(&column, &column);
        assert!((found[(0, 0)] / usual - 1.0).abs() < 1e-9);
        assert_eq!(found[(1, 1)], f64::INFINITY);
    }
}
