//! Local optima, how they were found, and why none was.

use thiserror::Error;

use crate::Trajectory;
use crate::trajectory::cost::Cost;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::stage::StageError;

/// Tolerances and limits at which a descent stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Largest KKT residual of a converged solution.
    pub residual: f64,
    /// An undamped step whose predicted decrease is below this share of `1 + |J|` is the last: beyond it the stage
    /// problems' own tolerance shows.
    pub decrease: f64,
    /// A full step need only be better than the worst of the iterate at which it begins and of this many before it.
    pub remembered_costs: usize,
    /// Most steps in one descent.
    pub iteration_limit: usize,
    /// Most [work](Statistics::work) of one descent; steps of a descent that goes nowhere pose up to four programmes.
    pub work_limit: usize,
    /// Most work that the comparison of homotopy classes may take of one plan; what is left goes on with the next one.
    pub comparison_work_limit: usize,
    /// Tolerance of a QP subproblem in search of a cheaper optimum, as a share of what is missing to the cost to beat: a promise
    /// need not be more exact than that. On the recorded problems it saves a quarter of the iterations and costs no optimum.
    pub exploration_share: f64,
    /// A safety row (1 − d²) or a road edge \[m\] violated by more than this makes a solution suspect.
    pub slack: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Tolerances {
            residual: 1e-8,
            decrease: 1e-11,
            remembered_costs: 0,
            iteration_limit: 100,
            work_limit: 4000,
            comparison_work_limit: 4000,
            exploration_share: 1e-4,
            slack: 1e-3,
        }
    }
}

impl Tolerances {
    /// Whether a descent found an optimum, and no safety row or road edge is violated there.
    pub(crate) fn trust(&self, outcome: &Result<Optimum, DescentError>) -> bool {
        outcome.as_ref().is_ok_and(|optimum| optimum.cost.unsafety() <= self.slack)
    }
}

/// The work of one or several descents, and how they ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Number of starting guesses that were tried.
    pub starts: usize,
    /// Number of quadratic programmes that were posed; those refused as not convex cost little.
    pub programmes: usize,
    /// Number of interior-point iterations in these programmes.
    pub inner_iterations: usize,
    /// KKT residual at the end, by the independent check.
    pub residual: f64,
    /// How many steps fell back from the exact Hessian to Gauss-Newton.
    pub fallbacks: usize,
    /// 1 if the motion is not optimal, for its descent reached the limit of its work: it violates nothing, or is cheaper and no
    /// less safe than the guess ([`Optimiser::optimise_or_improve`](super::Optimiser::optimise_or_improve)).
    pub unfinished: usize,
}

/// A local optimum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Optimum {
    /// Inputs and states at the optimum.
    pub iterate: Iterate,
    /// Cost of the iterate.
    pub cost: Cost,
    /// The work by which it was found.
    pub statistics: Statistics,
    /// The cost of the cheapest optimum of another homotopy class, if one was looked for and reached.
    pub runner_up_cost: Option<f64>,
}

/// Why no optimum was found.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum DescentError {
    /// A QP subproblem had no solution.
    #[error("step {step}: {source}")]
    Step {
        /// Index of the step.
        step: usize,
        /// The error of the stage solver.
        source: StageError,
    },
    /// The limit of steps or of work was reached at this iterate, which violates something.
    #[error("not converged after {} programmes: residual {:.1e}", .0.statistics.programmes, .0.statistics.residual)]
    NotConverged(Box<Optimum>),
    /// An exploration that was given up: even many times what its steps promise would not end below the cost to beat.
    #[error("no optimum below a cost of {bar} in sight: {expected} is promised")]
    NotBelow {
        /// The cost to beat.
        bar: f64,
        /// The cost that the last step promised.
        expected: f64,
        /// The work that the exploration took.
        statistics: Statistics,
    },
    /// An exploration that was given up: it entered a homotopy class whose optimum is known.
    #[error("led into a homotopy class whose optimum is known")]
    Settled(Statistics),
    /// The problem holds a number that is not finite.
    #[error("the problem has a cost that is not a number")]
    NotFinite,
}

impl Optimum {
    /// What another optimum has to cost less than to replace this one.
    pub(super) fn bar(&self) -> f64 {
        self.cost.total - 1e-9 * (1.0 + self.cost.total.abs())
    }

    /// The motion of one participant.
    pub fn trajectory(&self, participant: usize) -> Trajectory {
        self.iterate.trajectory(participant)
    }
}

impl Statistics {
    /// Work in units of some 20 µs: a quadratic programme posed, or an iteration inside one.
    pub fn work(&self) -> usize {
        self.programmes + self.inner_iterations
    }

    /// Adds the work of another optimisation; the worse residual counts.
    pub fn add(&mut self, other: &Statistics) {
        self.starts += other.starts;
        self.programmes += other.programmes;
        self.inner_iterations += other.inner_iterations;
        self.fallbacks += other.fallbacks;
        self.unfinished += other.unfinished;
        self.residual = self.residual.max(other.residual);
    }
}
