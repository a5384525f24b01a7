//! The cones K in which the slack s = b − Ax of a block of rows must lie, and the distances to them.
//!
//! | cone | s ∈ K | z ∈ K* |
//! |---|---|---|
//! | zero | s = 0 | z free |
//! | nonnegative | s ≥ 0 | z ≥ 0 |
//! | second order | ‖(s₁, …)‖₂ ≤ s₀ | the same |
//! | semidefinite | S ⪰ 0, s its stacked triangle | the same |

use crate::lapack;
use crate::sparse::{euclidean, largest};

/// The cone that must contain the slack s = b − Ax of a block of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Cone {
    /// Every row is an equality, s = 0.
    Zero,
    /// Every row is an inequality, s ≥ 0.
    Nonnegative,
    /// Consecutive groups of `dimension` rows each satisfy ‖(s₁, …)‖₂ ≤ s₀.
    SecondOrder {
        /// Rows of one cone: one for the bound s₀, the others for the vector below it.
        dimension: usize,
    },
    /// Consecutive groups of order·(order + 1)/2 rows are each the [`triangle`] of a symmetric matrix S ⪰ 0.
    Semidefinite {
        /// Number of rows and of columns of S.
        order: usize,
    },
}

/// The stacking of a symmetric matrix into rows: its upper triangle by columns, as (i, j, weight) with i ≤ j.
///
/// A row is the entry times its weight, which is 1 on the diagonal and √2 elsewhere. So the inner product of two stacked
/// matrices is the trace of their product.
pub fn triangle(order: usize) -> impl Iterator<Item = (usize, usize, f64)> {
    (0..order).flat_map(|j| (0..=j).map(move |i| (i, j, if i == j { 1.0 } else { std::f64::consts::SQRT_2 })))
}

impl Cone {
    /// The number of rows of one cone of this kind, in a block of `rows` rows.
    pub(crate) fn rows_of_one(self, rows: usize) -> usize {
        match self {
            Self::Zero | Self::Nonnegative => rows,
            Self::SecondOrder { dimension } => dimension,
            Self::Semidefinite { order } => order * (order + 1) / 2,
        }
    }

    /// Euclidean distance (for the rows of zero and nonnegative cones: largest per row) from `s` to K.
    pub(crate) fn distance(self, s: &[f64]) -> f64 {
        match self {
            Self::Zero => largest(s.iter().map(|v| v.abs())),
            Self::Nonnegative => largest(s.iter().map(|v| -v)),
            Self::SecondOrder { .. } => second_order_distance(s),
            Self::Semidefinite { order } => semidefinite_distance(order, s),
        }
    }

    /// Distance, measured like [`Cone::distance`], from `z` to the dual cone K*.
    pub(crate) fn dual_distance(self, z: &[f64]) -> f64 {
        match self {
            Self::Zero => 0.0,
            Self::Nonnegative | Self::SecondOrder { .. } | Self::Semidefinite { .. } => self.distance(z),
        }
    }

    /// Violation of complementarity of `s` and `z`: the largest |sᵢzᵢ| of inequality rows, or |sᵀz| of one second-order or
    /// semidefinite cone. It is zero for equalities, whose violation is a primal residual.
    pub(crate) fn complementarity(self, s: &[f64], z: &[f64]) -> f64 {
        let products = s.iter().zip(z).map(|(s, z)| s * z);
        match self {
            Self::Zero => 0.0,
            Self::Nonnegative => largest(products.map(f64::abs)),
            Self::SecondOrder { .. } | Self::Semidefinite { .. } => products.sum::<f64>().abs(),
        }
    }
}

/// Distance from (t, u) to { ‖u‖₂ ≤ t }: zero inside, ‖(t, u)‖₂ in the polar cone, else (‖u‖₂ − t)/√2.
fn second_order_distance(s: &[f64]) -> f64 {
    let Some((&bound, vector)) = s.split_first() else {
        return 0.0;
    };
    let norm = euclidean(vector);
    if norm <= bound {
        0.0
    } else if norm <= -bound {
        euclidean(&[bound, norm])
    } else {
        (norm - bound) * std::f64::consts::FRAC_1_SQRT_2
    }
}

/// Frobenius distance from S to the nearest semidefinite matrix: the length of its negative eigenvalues.
fn semidefinite_distance(order: usize, s: &[f64]) -> f64 {
    let mut matrix = vec![0.0; order * order];
    for ((i, j, weight), value) in triangle(order).zip(s) {
        matrix[i + j * order] = value / weight;
        matrix[j + i * order] = value / weight;
    }
    lapack::eigen(order, matrix).map_or(f64::NAN, |(values, _)| {
        let negative: Vec<f64> = values.into_iter().map(|value| value.min(0.0)).collect();
        euclidean(&negative)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: Cone = Cone::SecondOrder { dimension: 3 };

    #[test]
    fn the_distance_to_the_second_order_cone_is_exact_in_its_three_regions() {
        assert_eq!(BALL.distance(&[5.0, 3.0, 4.0]), 0.0);
        assert_eq!(BALL.distance(&[-12.0, 3.0, 4.0]), 13.0);
        let beside = BALL.distance(&[0.0, 3.0, 4.0]);
        assert!((beside - 5.0 / 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn an_equality_has_zero_slack_and_a_free_dual() {
        assert_eq!(Cone::Zero.distance(&[0.5, -2.0]), 2.0);
        assert_eq!(Cone::Zero.dual_distance(&[0.5, -2.0]), 0.0);
    }

    #[test]
    fn the_distance_to_an_inequality_counts_only_violations() {
        assert_eq!(Cone::Nonnegative.distance(&[3.0, -0.25]), 0.25);
        assert_eq!(Cone::Nonnegative.complementarity(&[3.0, 0.0], &[0.5, 9.0]), 1.5);
    }

    #[test]
    fn the_distance_to_the_semidefinite_cone_is_the_norm_of_the_negative_part() {
        let cone = Cone::Semidefinite { order: 2 };
        // [1 2; 2 1] has the eigenvalues 3 and −1.
        assert!((cone.distance(&[1.0, 2.0 * 2.0_f64.sqrt(), 1.0]) - 1.0).abs() < 1e-12);
        assert!(cone.distance(&[1.0, 0.5, 1.0]) == 0.0);
        assert!(cone.distance(&[f64::NAN, 0.5, 1.0]).is_nan());
        let inner: f64 = triangle(2).zip([1.0, 2.0, 1.0]).map(|((_, _, w), v)| (w * v) * (w * v)).sum();
        assert!((inner - 10.0).abs() < 1e-12, "trace of the square");
    }
}
