//! Sequential quadratic programming with the problem's own cost as merit function.
//!
//! From an iterate that obeys the dynamics, a QP subproblem ([`QpSubproblem`]) gives a direction `w` and the decrease that its model
//! predicts; a backtracking search takes the largest `α ∈ {1, ½, ¼, …}` with
//!
//! ```text
//! φ(u + α w) ≤ φ(u) − 10⁻⁴ α · predicted,      φ = J − (1 − κ) Σ linear·s       (Armijo)
//! ```
//!
//! where `J` is evaluated on rolled-out states, so that every iterate is admissible. `J` charges a violation `s` of a soft
//! row with `linear = 1e3`, far more than the multipliers of most plans, and a merit so steep would allow only tiny steps
//! along a curved boundary. An exact penalty need only exceed the multipliers (Nocedal and Wright, section 18.5), so the
//! search counts the share `κ = 2 max λ/linear` of it, at most all.
//!
//! A full step can be compared with the worst of some earlier iterates, too (Grippo, Lampariello and Lucidi, "A nonmonotone line search
//! technique for Newton's method", 1986). Games do so; for a planner that sees the outcome of one descent its end would depend on rounding.
//!
//! A full step that is refused is corrected to second order before it is shortened. The first step is Gauss-Newton; later
//! steps use the exact Hessian of the Lagrangian, which makes the end quadratic; where it is not positive definite on the
//! dynamics a third of the curvature is tried, then none: Gauss-Newton again. Steps that had to be cut very short are
//! followed by damped ones (Levenberg and Marquardt).
//!
//! With a receding horizon each descent starts warm ([`WarmStart`]): with the multipliers of its last optimum, a stage later, the
//! first step has the exact Hessian already, and where the shifted plan is optimal no step is taken. Steps also tell the next
//! one how far to look for rows that matter ([`Reach`](super::Reach)).
//!
//! [`Optimiser::optimise`] compares the homotopy classes that a problem has; an [`Exploration`] is a descent that only counts
//! if it ends below what is at hand.

mod comparison;
mod descent;
mod exploration;
mod homotopy_class;
mod homotopy_search;
mod hysteresis;
mod line_search;
mod optimiser;
mod optimum;
mod qp_subproblem;
mod search_setting;
mod subproblem_solver;
mod warm_start;

pub use optimiser::Optimiser;
pub use optimum::{DescentError, Optimum, Statistics, Tolerances};
pub use qp_subproblem::QpSubproblem;
pub use search_setting::HomotopySearch;
pub use warm_start::WarmStart;
