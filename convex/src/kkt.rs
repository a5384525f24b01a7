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
use crate::norm::{dot, largest, magnitude};
use crate::standard::StandardForm;

/// The four residuals of the optimality conditions, relative as described in [`crate::kkt`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residuals {
    /// Residual of Px + q + Aᵀz = 0.
    pub stationarity: f64,
    /// Residual of b − Ax ∈ K.
    pub primal: f64,
    /// Residual of z ∈ K*.
    pub dual: f64,
    /// Residual of (b − Ax)ᵀz = 0, cone by cone.
    pub complementarity: f64,
}

impl Residuals {
    /// The largest of the four.
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

pub(crate) fn of(form: &StandardForm, x: &[f64], z: &[f64]) -> OptimalityCheck {
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
/// Infinite when bᵀz ≥ 0. For z ∈ K*, every feasible x satisfies (Aᵀz)ᵀx ≤ bᵀz = −1. So a residual ρ proves that there
/// is no feasible x with ‖x‖₁ < 1/ρ.
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
