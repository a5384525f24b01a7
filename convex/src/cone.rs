//! The cones K in which the slack s = b − Ax of a block of rows must lie, and the distances to them.
//!
//! | cone | s ∈ K | z ∈ K* |
//! |---|---|---|
//! | zero | s = 0 | z free |
//! | nonnegative | s ≥ 0 | z ≥ 0 |
//! | second order | ‖(s₁, …)‖₂ ≤ s₀ | the same |

use crate::norm::{euclidean, largest};

/// What a block of rows asks of its slack s = b − Ax.
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
}

impl Cone {
    /// Rows of one cone of this kind, when it stands for several of them in a block of `rows` rows.
    pub(crate) fn rows_of_one(self, rows: usize) -> usize {
        match self {
            Self::Zero | Self::Nonnegative => rows,
            Self::SecondOrder { dimension } => dimension,
        }
    }

    /// Euclidean distance (for the rows of zero and nonnegative cones: largest per row) from `s` to K.
    pub(crate) fn distance(self, s: &[f64]) -> f64 {
        match self {
            Self::Zero => largest(s.iter().map(|v| v.abs())),
            Self::Nonnegative => largest(s.iter().map(|v| -v)),
            Self::SecondOrder { .. } => second_order_distance(s),
        }
    }

    /// Distance, measured like [`Cone::distance`], from `z` to the dual cone K*.
    pub(crate) fn dual_distance(self, z: &[f64]) -> f64 {
        match self {
            Self::Zero => 0.0,
            Self::Nonnegative | Self::SecondOrder { .. } => self.distance(z),
        }
    }

    /// How far `s` and `z` are from being complementary: the largest |sᵢzᵢ| of the inequality rows, |sᵀz| of
    /// one second-order cone. An equality has nothing to complement: its violation is a primal residual.
    pub(crate) fn complementarity(self, s: &[f64], z: &[f64]) -> f64 {
        let products = s.iter().zip(z).map(|(s, z)| s * z);
        match self {
            Self::Zero => 0.0,
            Self::Nonnegative => largest(products.map(f64::abs)),
            Self::SecondOrder { .. } => products.sum::<f64>().abs(),
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

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: Cone = Cone::SecondOrder { dimension: 3 };

    #[test]
    fn distance_to_the_second_order_cone_in_its_three_regions() {
        assert_eq!(BALL.distance(&[5.0, 3.0, 4.0]), 0.0);
        assert_eq!(BALL.distance(&[-12.0, 3.0, 4.0]), 13.0);
        let beside = BALL.distance(&[0.0, 3.0, 4.0]);
        assert!((beside - 5.0 / 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn equalities_bind_the_slack_and_free_the_dual() {
        assert_eq!(Cone::Zero.distance(&[0.5, -2.0]), 2.0);
        assert_eq!(Cone::Zero.dual_distance(&[0.5, -2.0]), 0.0);
    }

    #[test]
    fn inequalities_count_only_the_violated_side() {
        assert_eq!(Cone::Nonnegative.distance(&[3.0, -0.25]), 0.25);
        assert_eq!(Cone::Nonnegative.complementarity(&[3.0, 0.0], &[0.5, 9.0]), 1.5);
    }
}
