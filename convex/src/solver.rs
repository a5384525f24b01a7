//! The interior-point solver. Only this module names Clarabel.
//!
//! Clarabel orders and factorises one KKT matrix whose pattern is that of P, A and the cones. The ordering
//! and the symbolic factorisation are made once in [`Solver::new`]; [`Solver::update`] changes numbers only.
//!
//! Clarabel's own data update keeps the scaling (equilibration) of the first data, so that a result would
//! depend on earlier data. Here every update computes the scaling of the new data, which costs a few passes over
//! the entries. So an updated solver and a new one return bit-identical results.

use std::ops::Range;
use std::sync::Arc;

use clarabel::algebra::CscMatrix;
use clarabel::solver::traits::ProblemData;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use crate::kkt::Residuals;
use crate::sparse::{SparseColumns, dot};
use crate::standard::StandardForm;
use crate::{Block, Cone, ProblemError, Program, SolveError, Status, Variable, Variables, kkt};

/// Largest step, as a fraction of the step to the boundary of the cones, in the second attempt after 0.99 has stalled.
const SHORT_STEP: f64 = 0.9;

/// A problem in the form that Clarabel solves. It can be solved again with other numbers in the same pattern.
pub struct Solver {
    form: StandardForm,
    backend: DefaultSolver<f64>,
    backend_settings: DefaultSettings<f64>,
    accepted_tolerance: f64,
}

impl Solver {
    /// Checks `program`, finds its pattern and prepares the factorisation.
    ///
    /// # Errors
    /// [`ProblemError`] when the problem or the settings are malformed; the error names the variable, row or setting.
    pub fn new(program: &Program, settings: &SolverSettings) -> Result<Self, ProblemError> {
        settings.check()?;
        let form = StandardForm::new(program)?;
        let backend_settings = backend_settings(settings);
        let cones: Vec<_> = form
            .cones
            .iter()
            .map(|(cone, rows)| match cone {
                Cone::Zero => SupportedConeT::ZeroConeT(rows.len()),
                Cone::Nonnegative => SupportedConeT::NonnegativeConeT(rows.len()),
                Cone::SecondOrder { .. } => SupportedConeT::SecondOrderConeT(rows.len()),
                Cone::Semidefinite { order } => SupportedConeT::PSDTriangleConeT(*order),
            })
            .collect();
        let backend = DefaultSolver::new(
            &columns(&form.p),
            &form.q,
            &columns(&form.a),
            &form.b,
            &cones,
            backend_settings.clone(),
        )
        .map_err(refused)?;
        let accepted_tolerance = settings.accepted_tolerance;
        let mut solver = Self { form, backend, backend_settings, accepted_tolerance };
        solver.load()?;
        Ok(solver)
    }

    /// Replaces the numbers by those of `program`, which must have the variables, blocks and entries (positions, in the
    /// order written) of the program this solver was built for.
    ///
    /// # Errors
    /// [`ProblemError::PatternChanged`] when they differ, [`ProblemError::NotFinite`],
    /// [`ProblemError::NoSuchVariable`] or [`ProblemError::NegativeCurvature`] when a number is not
    /// acceptable. The solver then keeps its previous problem.
    pub fn update(&mut self, program: &Program) -> Result<(), ProblemError> {
        self.form.refill(program)?;
        self.load()
    }

    /// Solves the present problem. The result depends only on that problem and the settings.
    ///
    /// A result that Clarabel reports at full tolerance is accepted. A result that Clarabel itself calls "almost" (a limit was
    /// reached near a solution or a certificate) is accepted only if its residuals, recomputed from the data, are below
    /// [`SolverSettings::accepted_tolerance`]. Residuals of a certificate are scaled to bᵀz = −1 or qᵀx = −1.
    ///
    /// If Clarabel stalls, the problem is solved once more with shorter steps, which stay farther from the cones' boundaries.
    ///
    /// # Errors
    /// [`SolveError`]: infeasible or unbounded, with a certificate, or unsolved, with the reason.
    pub fn solve(&mut self) -> Result<ConicSolution, SolveError> {
        let outcome = self.attempt();
        match &outcome {
            Err(SolveError::Unsolved { status, .. }) if *status != Status::IterationLimit => {
                self.attempt_with(SHORT_STEP).or(outcome)
            }
            _ => outcome,
        }
    }

    /// Solves with steps of at most the fraction `step` of the way to the boundary of the cones.
    fn attempt_with(&mut self, step: f64) -> Result<ConicSolution, SolveError> {
        let usual = self.backend_settings.clone();
        let short = DefaultSettings { max_step_fraction: step, ..usual.clone() };
        // Clarabel allows a change of this setting at any time.
        let changed = self.backend.update_settings(short);
        let outcome = self.attempt();
        let restored = self.backend.update_settings(usual);
        debug_assert!(changed.is_ok() && restored.is_ok());
        outcome
    }

    fn attempt(&mut self) -> Result<ConicSolution, SolveError> {
        self.backend.solve();
        let result = &self.backend.solution;
        let form = &self.form;
        let accepted = |residual: f64| residual <= self.accepted_tolerance;
        let status = match result.status {
            SolverStatus::Solved => return Ok(self.solution(false)),
            SolverStatus::AlmostSolved => {
                let solution = self.solution(true);
                if accepted(solution.residuals.largest()) {
                    return Ok(solution);
                }
                Status::AlmostSolved
            }
            SolverStatus::PrimalInfeasible => return Err(self.primal_infeasible()),
            SolverStatus::AlmostPrimalInfeasible => {
                if accepted(kkt::infeasibility(form, &result.z)) {
                    return Err(self.primal_infeasible());
                }
                Status::AlmostPrimalInfeasible
            }
            SolverStatus::DualInfeasible => return Err(self.dual_infeasible()),
            SolverStatus::AlmostDualInfeasible => {
                if accepted(kkt::unboundedness(form, &result.x)) {
                    return Err(self.dual_infeasible());
                }
                Status::AlmostDualInfeasible
            }
            SolverStatus::MaxIterations => Status::IterationLimit,
            SolverStatus::NumericalError => Status::NumericalError,
            SolverStatus::InsufficientProgress => Status::InsufficientProgress,
            SolverStatus::MaxTime | SolverStatus::CallbackTerminated | SolverStatus::Unsolved => Status::Interrupted,
        };
        let iterations = result.iterations;
        Err(SolveError::Unsolved { status, iterations })
    }

    /// Passes the standard form to Clarabel: first the numbers, then their scaling, then the KKT matrix computed from both.
    fn load(&mut self) -> Result<(), ProblemError> {
        let data = &mut self.backend.data;
        data.P.nzval.copy_from_slice(&self.form.p.value);
        data.q.copy_from_slice(&self.form.q);
        data.A.nzval.copy_from_slice(&self.form.a.value);
        data.b.copy_from_slice(&self.form.b);
        data.equilibration.d.fill(1.0);
        data.equilibration.e.fill(1.0);
        data.equilibration.c = 1.0;
        data.equilibrate(&self.backend.cones, &self.backend_settings);
        // An empty update does not change the data, but Clarabel then recomputes what it derives from them: the KKT
        // matrix from P and A, and the norms of q and b.
        let unchanged: [f64; 0] = [];
        self.backend.update_data(&unchanged, &unchanged, &unchanged, &unchanged).map_err(refused)
    }

    fn solution(&self, almost: bool) -> ConicSolution {
        let result = &self.backend.solution;
        let report = kkt::check(&self.form, &result.x, &result.z);
        ConicSolution {
            x: result.x.clone(),
            z: result.z.clone(),
            slack: report.slack,
            blocks: self.form.blocks.clone(),
            objective: report.objective,
            iterations: result.iterations,
            residuals: report.residuals,
            almost,
        }
    }

    fn primal_infeasible(&self) -> SolveError {
        let z = &self.backend.solution.z;
        let certificate = scaled(z, -dot(&self.form.b, z));
        SolveError::PrimalInfeasible {
            iterations: self.backend.solution.iterations,
            conflict: self.form.blocks_in(&certificate),
            certificate,
        }
    }

    fn dual_infeasible(&self) -> SolveError {
        let x = &self.backend.solution.x;
        let certificate = scaled(x, -dot(&self.form.q, x));
        SolveError::DualInfeasible {
            iterations: self.backend.solution.iterations,
            unbounded: self.form.groups_in(&certificate),
            certificate,
        }
    }
}

impl std::fmt::Debug for Solver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Solver").field("form", &self.form).finish_non_exhaustive()
    }
}

/// Clarabel's settings: one thread, no time limit, no output, and no transformation that would change the pattern.
fn backend_settings(settings: &SolverSettings) -> DefaultSettings<f64> {
    DefaultSettings {
        max_iter: settings.iteration_limit,
        time_limit: f64::INFINITY,
        verbose: false,
        tol_gap_abs: settings.tolerance,
        tol_gap_rel: settings.tolerance,
        tol_feas: settings.tolerance,
        tol_infeas_abs: settings.tolerance,
        tol_infeas_rel: settings.tolerance,
        max_threads: 1,
        direct_solve_method: "qdldl".to_owned(),
        presolve_enable: false,
        chordal_decomposition_enable: false,
        input_sparse_dropzeros: false,
        ..DefaultSettings::default()
    }
}

fn columns(matrix: &SparseColumns) -> CscMatrix<f64> {
    CscMatrix::new(matrix.rows, matrix.columns(), matrix.start.clone(), matrix.row.clone(), matrix.value.clone())
}

fn scaled(vector: &[f64], divisor: f64) -> Vec<f64> {
    vector.iter().map(|v| v / divisor).collect()
}

fn refused(error: impl std::fmt::Display) -> ProblemError {
    ProblemError::Refused { reason: error.to_string() }
}

/// Accuracy and limits. There is deliberately no time limit: a result must not depend on the machine's load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverSettings {
    /// Tolerance of the duality gap, of feasibility and of infeasibility certificates. Default 1e-8.
    pub tolerance: f64,
    /// Tolerance at which a result that the solver itself calls "almost" is still accepted, provided that
    /// its residuals, recomputed from the problem's data ([`crate::kkt`]), stay below it. Default 1e-6.
    pub accepted_tolerance: f64,
    /// Maximum number of interior-point iterations. Default 200.
    pub iteration_limit: u32,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self { tolerance: 1e-8, accepted_tolerance: 1e-6, iteration_limit: 200 }
    }
}

impl SolverSettings {
    /// Refuses settings with which no problem can be solved.
    pub(crate) fn check(&self) -> Result<(), ProblemError> {
        let tolerances = [("tolerance", self.tolerance), ("accepted_tolerance", self.accepted_tolerance)];
        for (name, value) in tolerances {
            if !(value > 0.0 && value < 1.0) {
                let wanted = "between 0 and 1";
                return Err(ProblemError::Setting { name, value, wanted });
            }
        }
        if self.iteration_limit == 0 {
            return Err(ProblemError::Setting { name: "iteration_limit", value: 0.0, wanted: "at least 1" });
        }
        Ok(())
    }
}

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
