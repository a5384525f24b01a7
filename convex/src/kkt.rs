//! Residuals of optimality and infeasibility, computed from the problem's data and independently of the solver.
//!
//! For the problem min ½xᵀPx + qᵀx subject to s = b − Ax ∈ K, with the dual cone K*, a pair (x, z) is optimal exactly when
//!
//! | condition | residual |
//! |---|---|
//! | stationarity: Px + q + Aᵀz = 0 | ‖Px + q + Aᵀz‖∞ |
//! | primal feasibility: s ∈ K | largest distance of a cone's part of s to the cone |
//! | dual feasibility: z ∈ K* | largest distance of a cone's part of z to the dual cone |
//! | complementarity: sᵀz = 0, cone by cone | largest \|sᵀz\| of one cone (of one row for inequalities) |
//!
//! Each residual is divided by max(1, the largest magnitude among its terms). So a residual of 1e-8 is relative for large
//! data and absolute for small data.

use std::ops::Range;

use crate::Cone;
use crate::sparse::{dot, largest, magnitude};
use crate::standard::StandardForm;

/// The four residuals of the optimality conditions, relative as described in [`crate::kkt`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residuals {
    /// Residual of stationarity, Px + q + Aᵀz = 0.
    pub stationarity: f64,
    /// Residual of primal feasibility, b − Ax ∈ K.
    pub primal: f64,
    /// Residual of dual feasibility, z ∈ K*.
    pub dual: f64,
    /// Residual of complementarity, (b − Ax)ᵀz = 0, cone by cone.
    pub complementarity: f64,
}

impl Residuals {
    /// The largest of the four residuals.
    #[must_use]
    pub fn largest(&self) -> f64 {
        // `f64::max` ignores a NaN, which would then count as a small residual.
        let all = [self.stationarity, self.primal, self.dual, self.complementarity];
        all.into_iter().fold(0.0, |worst, v| if v > worst || v.is_nan() { v } else { worst })
    }
}

/// The residuals of a pair (x, z), with the slack and the cost from which they were computed.
pub(crate) struct OptimalityCheck {
    pub(crate) residuals: Residuals,
    /// The slack s = b − Ax.
    pub(crate) slack: Vec<f64>,
    /// The cost ½xᵀPx + qᵀx.
    pub(crate) objective: f64,
}

pub(crate) fn check(form: &StandardForm, x: &[f64], z: &[f64]) -> OptimalityCheck {
    let px = form.p.symmetric_times(x);
    let ax = form.a.times(x);
    let atz = form.a.transposed_times(z);
    let slack: Vec<f64> = form.b.iter().zip(&ax).map(|(b, ax)| b - ax).collect();
    let gradient: Vec<f64> = px.iter().zip(&form.q).zip(&atz).map(|((px, q), atz)| px + q + atz).collect();
    let quadratic = 0.5 * dot(x, &px);
    let linear = dot(&form.q, x);
    // At an optimum the two objectives agree: ½xᵀPx + qᵀx = −½xᵀPx − bᵀz.
    let objectives = [quadratic + linear, quadratic + dot(&form.b, z)];
    let residuals = Residuals {
        stationarity: magnitude(&gradient) / scale(&[&px, &form.q, &atz]),
        primal: worst(form, |cone, rows| cone.distance(&slack[rows])) / scale(&[&ax, &form.b]),
        dual: worst(form, |cone, rows| cone.dual_distance(&z[rows])) / scale(&[z]),
        complementarity: worst(form, |cone, rows| cone.complementarity(&slack[rows.clone()], &z[rows]))
            / scale(&[&objectives]),
    };
    OptimalityCheck { residuals, slack, objective: objectives[0] }
}

/// Residual of a certificate z of infeasibility, scaled to bᵀz = −1: the larger of ‖Aᵀz‖∞ and the distance of z to K*.
///
/// Infinite when bᵀz ≥ 0. For z ∈ K*, every feasible x satisfies (Aᵀz)ᵀx ≤ bᵀz = −1. So a residual ρ proves that no
/// x with ‖x‖₁ < 1/ρ is feasible.
pub(crate) fn infeasibility(form: &StandardForm, z: &[f64]) -> f64 {
    let gain = -dot(&form.b, z);
    let atz = form.a.transposed_times(z);
    let outside = worst(form, |cone, rows| cone.dual_distance(&z[rows]));
    relative(magnitude(&atz).max(outside), gain)
}

/// Residual of a certificate x of unboundedness, a direction of unlimited descent scaled to qᵀx = −1: the larger of ‖Px‖∞
/// and the distance of −Ax to K. Infinite when qᵀx ≥ 0.
pub(crate) fn unboundedness(form: &StandardForm, x: &[f64]) -> f64 {
    let gain = -dot(&form.q, x);
    let px = form.p.symmetric_times(x);
    let slack: Vec<f64> = form.a.times(x).iter().map(|v| -v).collect();
    let outside = worst(form, |cone, rows| cone.distance(&slack[rows]));
    relative(magnitude(&px).max(outside), gain)
}

fn relative(residual: f64, gain: f64) -> f64 {
    if gain > 0.0 { residual / gain } else { f64::INFINITY }
}

fn worst(form: &StandardForm, residual: impl Fn(Cone, Range<usize>) -> f64) -> f64 {
    largest(form.cones.iter().map(|(cone, rows)| residual(*cone, rows.clone())))
}

fn scale(parts: &[&[f64]]) -> f64 {
    parts.iter().fold(1.0, |scale, part| magnitude(part).max(scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Program;

    /// min 2x² − 100x subject to 3x + y ≤ 30 and x ≤ 400.
    fn form() -> StandardForm {
        let mut program = Program::new();
        let variables = program.variables("x and y", 2);
        let (x, y) = (variables.at(0), variables.at(1));
        program.quadratic(x, x, 4.0);
        program.linear(x, -100.0);
        let rows = program.at_most("rows");
        program.row(rows, [(x, 3.0), (y, 1.0)], 30.0);
        program.row(rows, [(x, 1.0)], 400.0);
        StandardForm::new(&program).expect("a sound program")
    }

    /// Every term and every scale, by hand.
    #[test]
    fn residuals_are_relative_to_their_largest_term() {
        let OptimalityCheck { residuals, slack, objective } = check(&form(), &[10.0, 5.0], &[-8.0, 20.0]);
        assert_eq!((slack, objective), (vec![-5.0, 390.0], 200.0 - 1000.0));
        // Px = (40, 0), q = (−100, 0), Aᵀz = (−4, −8).
        assert_eq!(residuals.stationarity, 64.0 / 100.0);
        assert_eq!(residuals.primal, 5.0 / 400.0);
        assert_eq!(residuals.dual, 8.0 / 20.0);
        // The objectives are −800 and 200 + bᵀz = 7960.
        assert_eq!(residuals.complementarity, 390.0 * 20.0 / 7960.0);
        assert_eq!(residuals.largest(), 390.0 * 20.0 / 7960.0);
    }

    #[test]
    fn certificates_are_scaled_to_a_unit_gain() {
        // bᵀz = −60, Aᵀz = (−6, −2), and z is outside of its cone by 2.
        assert_eq!(infeasibility(&form(), &[-2.0, 0.0]), 6.0 / 60.0);
        // qᵀx = −200, Px = (8, 0), −Ax = (−6, −2).
        assert_eq!(unboundedness(&form(), &[2.0, 0.0]), 8.0 / 200.0);
        assert_eq!([infeasibility(&form(), &[0.0; 2]), unboundedness(&form(), &[0.0; 2])], [f64::INFINITY; 2]);
        assert_eq!(infeasibility(&form(), &[2.0, 0.0]), f64::INFINITY, "it gains nothing");
    }
}
