//! The solution of a problem, read by the handles of its variables and blocks.

use std::ops::Range;
use std::sync::Arc;

use crate::kkt::{self, Residuals};
use crate::standard::StandardForm;
use crate::{Block, ProblemError, Program, Variable, Variables};

/// An optimal point x with its duals z.
///
/// The methods that take a handle panic if the handle belongs to a problem with more variables or blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct ConicSolution {
    pub(crate) x: Vec<f64>,
    pub(crate) z: Vec<f64>,
    pub(crate) slack: Vec<f64>,
    pub(crate) blocks: Arc<[Range<usize>]>,
    /// The optimal cost ½xᵀPx + qᵀx.
    pub objective: f64,
    /// Number of interior-point iterations.
    pub iterations: u32,
    /// Residuals of (x, z) in the optimality conditions, computed from the problem's data.
    pub residuals: Residuals,
    /// Whether the solver stopped short of [`SolverSettings::tolerance`](crate::SolverSettings::tolerance), and the point
    /// was accepted because its residuals are below
    /// [`SolverSettings::accepted_tolerance`](crate::SolverSettings::accepted_tolerance).
    pub almost: bool,
}

impl ConicSolution {
    /// The values of a group of variables.
    #[must_use]
    pub fn value(&self, variables: Variables) -> &[f64] {
        &self.x[variables.range()]
    }

    /// The value of one variable.
    #[must_use]
    pub fn at(&self, variable: Variable) -> f64 {
        self.x[variable.0]
    }

    /// The duals z of a block's rows: the optimal cost changes by −z per unit that b is raised.
    #[must_use]
    pub fn dual(&self, block: Block) -> &[f64] {
        &self.z[self.blocks[block.0].clone()]
    }

    /// The slacks b − Ax of a block's rows: zero where an inequality is active.
    #[must_use]
    pub fn slack(&self, block: Block) -> &[f64] {
        &self.slack[self.blocks[block.0].clone()]
    }

    /// The values of all variables, in the order of declaration.
    #[must_use]
    pub fn point(&self) -> &[f64] {
        &self.x
    }

    /// The duals of all rows, block after block.
    #[must_use]
    pub fn duals(&self) -> &[f64] {
        &self.z
    }
}

/// The residuals of `solution` in the optimality conditions of `program`.
///
/// # Errors
/// As [`Solver::new`](crate::Solver::new), when `program` is malformed.
///
/// # Panics
/// When `solution` belongs to a problem of other sizes.
pub fn residuals(program: &Program, solution: &ConicSolution) -> Result<Residuals, ProblemError> {
    let form = StandardForm::new(program)?;
    Ok(kkt::check(&form, solution.point(), solution.duals()).residuals)
}
