//! Sparse optimal control of a network over stages, with an interior-point method whose linear algebra is a Riccati recursion.
//!
//! ```text
//! minimise    Σ_t qₜᵀv(t) + ½ v(t)ᵀ diag(rₜ) v(t) + gₜᵀx(t+1) + ½ x(t+1)ᵀ diag(Qₜ) x(t+1) + Σ_k c₁ s_k + ½ c₂ s_k²  +  ϖ p
//! subject to  x(t+1) = A x(t) + B v(t) + d(t),    lower ≤ v(t) ≤ upper
//!             σ_k x_i(t+1) ≤ b_k + s_k,  s_k ≥ 0                    soft bounds of single nodes
//!             κₜᵀv(t) ≤ p,  p ≥ p₀                                  a peak that all stages share, where there is one
//! ```
//!
//! `x` are the temperatures of the nodes, `v` inputs that heat or cool a zone. A stage may hold its inputs for several steps of
//! the model. The problem always has a solution: bounds of temperatures are soft.
//!
//! The method is Mehrotra's predictor-corrector (Nocedal and Wright, *Numerical Optimization*, 2006, section 16.6) from a point that
//! keeps all rows, as Rao, Wright and Rawlings propose for model predictive control ("Application of interior-point methods
//! to model predictive control", 1998): the Newton system is an optimal control problem without inequalities, which the
//! recursion solves in time linear in the number of stages and cubic in that of the nodes. The matrices of the model are those of a
//! network, `A = I − B L` with a sparse Laplacian `L`, so that a stage takes two dense products of nodes by nodes.

pub(crate) mod dense;
mod interior_point;
mod pairs;
mod program;
mod recursion;

pub use interior_point::solve;
pub use program::{HeatInput, Peak, PlanStage, SoftBound, StageMap, StagedError, StagedProgram, StagedSolution};
