//! Errors: a malformed problem ([`ProblemError`]), and a well-formed problem that is infeasible, unbounded or unsolved
//! ([`SolveError`]).

use std::fmt;

use crate::place::{ProblemPlace, VariablePlace};

/// Why a problem or its settings are malformed; nothing was solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProblemError {
    /// The problem has no variables.
    #[error("the problem has no variables: declare some with Program::variables")]
    Empty,
    /// Two groups of variables, or two blocks of rows, bear one name.
    #[error("the name `{name}` is used twice: names tell variables and rows apart in errors")]
    DuplicateName {
        /// The repeated name.
        name: String,
    },
    /// A cost or a row uses a variable that this problem does not have.
    #[error("{place} uses variable number {index}, but the problem has {count}: the handle is another problem's")]
    NoSuchVariable {
        /// The cost or row at fault.
        place: ProblemPlace,
        /// The position of the variable, from zero.
        index: usize,
        /// How many variables there are.
        count: usize,
    },
    /// A number is infinite or not a number.
    #[error("{place} is {value}: every number of a problem must be finite")]
    NotFinite {
        /// The cost or row at fault.
        place: ProblemPlace,
        /// The offending number.
        value: f64,
    },
    /// The rows of a second-order or semidefinite block do not divide into cones.
    #[error("block `{block}` has {rows} rows, not a multiple of the {dimension} of one of its cones (at least 1)")]
    ConeSize {
        /// Name of the block.
        block: String,
        /// How many rows it has.
        rows: usize,
        /// Rows of one cone.
        dimension: usize,
    },
    /// The quadratic cost curves downwards along one variable, so it is not convex.
    #[error("the quadratic cost of {variable} is {value}: a convex cost needs at least zero")]
    NegativeCurvature {
        /// The variable along which the cost curves downwards.
        variable: VariablePlace,
        /// The diagonal entry of P for this variable.
        value: f64,
    },
    /// An update has other variables, rows or entries than the problem the solver was built for.
    #[error("{place} differs in shape from the problem this solver was built for: build a new solver")]
    PatternChanged {
        /// The first place that differs.
        place: ProblemPlace,
    },
    /// A setting is out of range.
    #[error("setting `{name}` is {value}: it must be {wanted}")]
    Setting {
        /// The field of [`SolverSettings`](crate::SolverSettings).
        name: &'static str,
        /// Value of the setting.
        value: f64,
        /// Values that would work.
        wanted: &'static str,
    },
    /// The solver library refused a problem that this crate found well-formed.
    #[error("the solver library refused the problem: {reason}")]
    Refused {
        /// The message of the library.
        reason: String,
    },
}

/// Why a well-formed problem has no solution, or why none was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// No x satisfies every row: proved by a certificate z with Aᵀz = 0, z ∈ K*, bᵀz = −1.
    #[error("no point satisfies every row (shown in {iterations} iterations); the conflict is among {}", list(.conflict))]
    PrimalInfeasible {
        /// Number of interior-point iterations.
        iterations: u32,
        /// Blocks with a notable part in the certificate, in the problem's order: where to look first.
        conflict: Vec<String>,
        /// The certificate z, one number a row, blocks in the problem's order.
        certificate: Vec<f64>,
    },
    /// The cost falls without end: proved by a direction x with Px = 0, −Ax ∈ K, qᵀx = −1.
    #[error("the cost is unbounded below (shown in {iterations} iterations), along {}", list(.unbounded))]
    DualInfeasible {
        /// Number of interior-point iterations.
        iterations: u32,
        /// Groups of variables with a notable part in the direction, in the problem's order.
        unbounded: Vec<String>,
        /// The direction x, one number a variable.
        certificate: Vec<f64>,
    },
    /// Neither a solution nor a certificate was found.
    #[error("unsolved after {iterations} iterations: {status}")]
    Unsolved {
        /// Why the solver stopped.
        status: Status,
        /// Number of interior-point iterations.
        iterations: u32,
    },
}

/// Why the solver stopped without a result that could be accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// The iterate nearly solves the problem, but its residuals exceed the accepted tolerance.
    AlmostSolved,
    /// The iterate nearly proves infeasibility, but its certificate exceeds the accepted tolerance.
    AlmostPrimalInfeasible,
    /// The iterate nearly proves unboundedness, but its certificate exceeds the accepted tolerance.
    AlmostDualInfeasible,
    /// The iteration limit was reached.
    IterationLimit,
    /// The linear algebra broke down.
    NumericalError,
    /// The steps became too small.
    InsufficientProgress,
    /// The solver stopped for a reason this crate never asks for (time limit, callback, not started).
    Interrupted,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AlmostSolved => "nearly solved, beyond the accepted tolerance",
            Self::AlmostPrimalInfeasible => "nearly shown infeasible, beyond the accepted tolerance",
            Self::AlmostDualInfeasible => "nearly shown unbounded, beyond the accepted tolerance",
            Self::IterationLimit => "iteration limit reached",
            Self::NumericalError => "the linear algebra broke down",
            Self::InsufficientProgress => "no further progress",
            Self::Interrupted => "interrupted",
        })
    }
}

fn list(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}
