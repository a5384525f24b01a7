//! Sparse convex problems with named variables and rows. Solving one returns a [`Result`].
//!
//! # The problem
//!
//! ```text
//! minimise   ½ xᵀP x + qᵀx          P symmetric, positive semidefinite
//! subject to A x + s = b,  s ∈ K    K a product of cones
//! ```
//!
//! Rows come in named blocks, each with its [`Cone`]: equalities (aᵀx = b), inequalities (aᵀx ≤ b)
//! second-order cones (b − Ax ∈ { (t, u) : ‖u‖₂ ≤ t }) and symmetric matrices that are positive semidefinite
//! ([`triangle`] says how they are stacked). The duals z ∈ K* carry the sign for which
//!
//! ```text
//! P x + q + Aᵀz = 0,    sᵀz = 0,
//! ```
//!
//! so the dual of an inequality is at least zero, and raising b by one lowers the optimal cost by z, to first
//! order. [`kkt`] checks these conditions from the problem's data.
//!
//! # Use
//!
//! Write a [`Program`], give it to a [`Solver`], read the [`ConicSolution`] by handle. The point of a disc of
//! radius 1 that is nearest to (3, 4) lies on the ray towards it:
//!
//! ```
//! use interplay_convex::{Program, SolverSettings, Solver};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut program = Program::new();
//! let x = program.variables("x", 2);
//! let disc = program.second_order("disc", 3);
//! for (variable, target) in x.iter().zip([3.0, 4.0]) {
//!     program.quadratic(variable, variable, 1.0); // ½ (x − target)², up to a constant
//!     program.linear(variable, -target);
//! }
//! program.row(disc, [], 1.0); // s₀ = 1
//! program.row(disc, [(x.at(0), -1.0)], 0.0); // s₁ = x₀
//! program.row(disc, [(x.at(1), -1.0)], 0.0); // s₂ = x₁
//!
//! let mut solver = Solver::new(&program, &SolverSettings::default())?;
//! let solution = solver.solve()?;
//! assert!((solution.at(x.at(0)) - 0.6).abs() < 1e-6);
//! assert!((solution.at(x.at(1)) - 0.8).abs() < 1e-6);
//! # Ok(())
//! # }
//! ```
//!
//! To solve another problem with the same sparsity pattern, call [`Program::clear`], write the new numbers at the same
//! positions in the same order, and call [`Solver::update`]. It keeps the ordering and the symbolic factorisation, and
//! refuses a changed pattern. The result is bit-identical to that of a new solver.
//!
//! # Outcomes
//!
//! [`Solver::new`] and [`Solver::update`] refuse a malformed problem ([`ProblemError`]). [`Solver::solve`] returns a
//! solution, or a [`SolveError`]. The errors "infeasible" and "unbounded" contain a certificate and the names of the
//! variables or rows in it. Any other failure is "unsolved", with the [`Status`] and the number of iterations.

mod check;
mod cone;
mod error;
pub mod kkt;
mod lapack;
mod place;
mod program;
mod solver;
mod sparse;
mod standard;

pub use cone::{Cone, triangle};
pub use error::{ProblemError, SolveError, Status};
pub use place::{ProblemPlace, RowPlace, VariablePlace};
pub use program::{Block, Program, Variable, Variables};
pub use solver::{ConicSolution, Solver, SolverSettings, residuals};
