//! The interior-point iteration (see the parent module for the equations).

use super::columns::{Columns, Start, larger};
use super::riccati::{PairHessian, Riccati, VehicleHessian};
use super::rows::{Inequalities, Point};
use super::trajectory_row::ExpandedTrajectoryRow;
use crate::trajectory::stage::qp::{Hessian, Reach, StageQp};
use crate::trajectory::stage::solution::StageSolution;
use crate::trajectory::stage::solver::{StageError, StageSolver};

/// Tolerance on the dual residual as a share of its start, per tolerance on everything else.
const DUAL_TOLERANCE_RATIO: f64 = 1e-3;
/// Largest residual that is accepted where rounding stops the iteration above the tolerance.
const ACCEPTED_RESIDUAL: f64 = 1e-7;
/// Below this mean complementarity Newton steps are refined: the factorisation has lost digits that matter.
const REFINEMENT_COMPLEMENTARITY: f64 = 1e-4;
/// The iteration does not aim at a complementarity below this share of the tolerance.
const MIN_CENTRING_RATIO: f64 = 1e-2;
/// Weight on the inputs where the Hessian is singular but for rounding ([`Interior::input_regularization`]).
const INPUT_REGULARIZATION: f64 = 1e-3;
/// A derivative of the Lagrangian over the inputs below this is treated as zero.
const STATIONARITY_TOLERANCE: f64 = 1e-8;
/// Largest number of steps after convergence that reduce the derivative to [`STATIONARITY_TOLERANCE`].
const MAX_STEPS_WITHOUT_GAIN: usize = 2;
/// Largest number of iterations.
const ITERATION_LIMIT: usize = 50;
/// A multiplier beyond this with a row still violated means that the rows contradict each other.
const INFEASIBLE_MULTIPLIER: f64 = 1e9;

/// The structured solver of stage problems with one to four vehicles.
#[derive(Clone, Debug, Default)]
pub struct Structured {
    one: Interior<2, 6>,
    two: Interior<4, 12>,
    three: Interior<6, 18>,
    four: Interior<8, 24>,
}

impl StageSolver for Structured {
    fn accepts_curvature(&self) -> bool {
        true
    }

    fn solve(&mut self, problem: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError> {
        match problem.vehicles.len() {
            1 => self.one.solve(problem, solution, warm),
            2 => self.two.solve(problem, solution, warm),
            3 => self.three.solve(problem, solution, warm),
            4 => self.four.solve(problem, solution, warm),
            count => {
                let status = format!("{count} deciding vehicles, at most 4 are supported");
                Err(StageError::Unsolved { status, iterations: 0 })
            }
        }
    }
}

/// The memory of one solver of `W/2` vehicles; nothing is allocated once it has its size.
#[derive(Clone, Debug, Default)]
pub(super) struct Interior<const W: usize, const Z: usize> {
    riccati: Riccati<W, Z>,
    pub(super) inequalities: Inequalities,
    pub(super) columns: Columns,
    pub(super) hessians: Vec<VehicleHessian>,
    pub(super) pairs: Vec<PairHessian>,
    /// The part of them that stays the same.
    pub(super) smooth_hessians: Vec<VehicleHessian>,
    pub(super) smooth_pairs: Vec<PairHessian>,
    /// Added to the Hessian over the inputs where it is singular but for rounding; steps are then a little short.
    pub(super) input_regularization: f64,
    /// Where the iteration stands.
    pub(super) point: Point,
    /// Its next step.
    pub(super) step: Point,
    /// What refinement adds to it.
    correction: Point,
    /// Gradient of the smooth cost at the point.
    pub(super) cost_gradient: Point,
    /// The same with the rows' pull.
    pub(super) gradient: Point,
    /// The rows over whole trajectories at the point.
    pub(super) trajectory_rows: Vec<ExpandedTrajectoryRow>,
}

impl<const W: usize, const Z: usize> Interior<W, Z> {
    pub(super) const VEHICLES: usize = W / 2;

    fn solve(&mut self, qp: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError> {
        let warm = warm && solution.fits(qp);
        solution.shape_like(qp);
        let mut iterations = 0;
        let mut outcome = Err(StageError::Unsolved { status: String::new(), iterations });
        if warm || qp.reach.is_some() {
            let start = if warm { Start::WARM } else { Start::COLD };
            outcome = self.attempt(qp, solution, start, qp.reach.as_ref(), &mut iterations);
        }
        if let Err(StageError::Unsolved { .. }) = outcome {
            outcome = self.attempt(qp, solution, Start::COLD, None, &mut iterations);
        }
        if matches!(outcome, Err(StageError::Unsolved { .. })) && qp.hessian == Hessian::GaussNewton {
            self.input_regularization = INPUT_REGULARIZATION;
            outcome = self.attempt(qp, solution, Start::COLD, None, &mut iterations);
            self.input_regularization = 0.0;
        }
        solution.iterations = iterations;
        outcome?;
        self.write(solution);
        Ok(())
    }

    /// One way to the solution, with the inequalities within reach.
    fn attempt(
        &mut self,
        qp: &StageQp,
        known: &StageSolution,
        start: Start,
        reach: Option<&Reach>,
        iterations: &mut usize,
    ) -> Result<(), StageError> {
        self.begin(qp, known, start, reach);
        let unsolved = |status, iterations| Err(StageError::Unsolved { status, iterations });
        match self.iterate(qp, iterations) {
            Ok(()) if !self.inequalities.far_ones_hold(&self.point) => {
                unsolved("the solution is farther than expected".to_owned(), *iterations)
            }
            // Without curvature every problem is convex: it was rounding.
            Err(StageError::NotConvex { stage }) if qp.hessian == Hessian::GaussNewton => {
                unsolved(format!("the factorisation broke down at stage {stage}"), *iterations)
            }
            outcome => outcome,
        }
    }

    /// Lists the inequalities, and sets slacks and multipliers at the iterate itself.
    fn begin(&mut self, qp: &StageQp, known: &StageSolution, start: Start, reach: Option<&Reach>) {
        self.inequalities.fill(qp, known, reach);
        let rows = self.inequalities.bounds.len() + self.inequalities.rows.len() + qp.trajectory_rows.len();
        let hard = rows - self.inequalities.weights.len();
        self.columns.shape(hard, self.inequalities.weights.iter().copied());
        self.trajectory_rows.resize_with(qp.trajectory_rows.len(), ExpandedTrajectoryRow::default);
        self.trajectory_rows.iter_mut().zip(&qp.trajectory_rows).for_each(|(expanded, row)| expanded.shape_like(row));
        self.point.clear(qp.horizon * Self::VEHICLES);
        self.fill_smooth_hessians(qp);
        self.refresh_values(qp);
        self.columns.begin(start, &self.inequalities.multipliers);
    }

    /// Newton's method with predictor and corrector until every residual is small.
    fn iterate(&mut self, qp: &StageQp, iterations: &mut usize) -> Result<(), StageError> {
        let count = self.columns.pairs().max(1) as f64;
        // The dual residual is linear in the unknowns, so every step of length α leaves 1 − α of it.
        let (mut dual_share, mut polished) = (1.0, 0);
        for _ in 0..ITERATION_LIMIT {
            let (complementarity, primal) = self.columns.measure();
            if complementarity < qp.tolerance
                && primal < qp.tolerance
                && dual_share < DUAL_TOLERANCE_RATIO * qp.tolerance
            {
                // Multipliers come out of large weights with few digits; a step that is next to nothing cleans them.
                if polished == MAX_STEPS_WITHOUT_GAIN || self.stationarity(qp) < STATIONARITY_TOLERANCE {
                    return Ok(());
                }
                polished += 1;
            }
            if !complementarity.is_finite() {
                break;
            }
            let largest = self.columns.multiplier.iter().copied().fold(0.0, larger);
            if largest > INFEASIBLE_MULTIPLIER && primal > qp.tolerance.sqrt() {
                return Err(StageError::Infeasible { iterations: *iterations });
            }
            *iterations += 1;
            self.columns.weigh();
            self.assemble(qp);
            match self.riccati.factor(qp, &self.hessians, &self.pairs) {
                Err(_) if polished > 0 => return Ok(()),
                outcome => outcome?,
            }
            self.respond(qp);
            self.fill_cost_gradient(qp);
            self.columns.aim(0.0, false);
            self.newton(qp, false);
            let affine = self.columns.step();
            let share = if affine.ratio > 1.0 { 1.0 / affine.ratio } else { 1.0 };
            let left = complementarity + share * (affine.linear + share * affine.quadratic) / count;
            // Without any inequality there is nothing to centre; beyond the tolerance there is nothing to gain but rounding.
            let centring = if complementarity > 0.0 { (left / complementarity).powi(3) * complementarity } else { 0.0 };
            let centring = larger(centring, MIN_CENTRING_RATIO * qp.tolerance);
            self.columns.aim(centring, true);
            self.newton(qp, complementarity < REFINEMENT_COMPLEMENTARITY);
            let ratio = self.columns.step().ratio;
            let boundary = 1.0 - complementarity.clamp(1e-6, 5e-3);
            let share = if ratio > boundary { boundary / ratio } else { 1.0 };
            self.columns.advance(share);
            self.point.add(share, &self.step);
            dual_share *= 1.0 - share;
            self.refresh_values(qp);
        }
        let (complementarity, worst) = self.columns.measure();
        if complementarity < ACCEPTED_RESIDUAL && worst < ACCEPTED_RESIDUAL && dual_share < ACCEPTED_RESIDUAL {
            return Ok(());
        }
        let status = format!("residual {worst:.1e}, dual residual at {dual_share:.1e} of its start");
        Err(StageError::Unsolved { status, iterations: *iterations })
    }

    /// Every inequality at the point, and the gradients of rows over whole trajectories.
    fn refresh_values(&mut self, qp: &StageQp) {
        let (bounds, rows) = self.columns.value.split_at_mut(self.inequalities.bounds.len());
        for (bound, value) in self.inequalities.bounds.iter().zip(bounds) {
            *value = bound.room + bound.slope(&self.point);
        }
        let (rows, trajectories) = rows.split_at_mut(self.inequalities.rows.len());
        for (row, value) in self.inequalities.rows.iter().zip(rows) {
            *value = row.value + row.slope(&self.point.states);
        }
        for ((row, expanded), value) in qp.trajectory_rows.iter().zip(&mut self.trajectory_rows).zip(trajectories) {
            *value = expanded.refresh(row, &self.point, Self::VEHICLES);
        }
    }

    /// `H⁻¹ v` of every row over a whole trajectory, for Sherman and Morrison.
    fn respond(&mut self, qp: &StageQp) {
        let weights = &self.columns.weight[self.columns.len() - self.trajectory_rows.len()..];
        for index in 0..self.trajectory_rows.len() {
            let (before, after) = self.trajectory_rows.split_at_mut(index);
            let expanded = &mut after[0];
            self.gradient.clear(qp.horizon * Self::VEHICLES);
            // The gradient −v makes the solve return H⁻¹ v.
            expanded.pull(-1.0, &mut self.gradient, Self::VEHICLES);
            expanded.response.clear(qp.horizon * Self::VEHICLES);
            self.riccati.solve(qp, &self.gradient, &mut expanded.response);
            for (earlier, weight) in before.iter().zip(weights) {
                earlier.correct(*weight, &mut expanded.response, Self::VEHICLES);
            }
        }
    }

    /// One Newton step towards the targets, if asked with a refinement; leaves its slopes in the columns.
    fn newton(&mut self, qp: &StageQp, refined: bool) {
        self.fill_gradient(false);
        self.step.states.resize(self.gradient.states.len(), [0.0; 4]);
        self.step.inputs.resize(self.gradient.inputs.len(), [0.0; 2]);
        self.riccati.solve(qp, &self.gradient, &mut self.step);
        correct(&self.columns, &self.trajectory_rows, &mut self.step, Self::VEHICLES);
        if refined {
            self.leave_residual(qp);
            self.correction.clear(qp.horizon * Self::VEHICLES);
            self.riccati.solve(qp, &self.gradient, &mut self.correction);
            correct(&self.columns, &self.trajectory_rows, &mut self.correction, Self::VEHICLES);
            self.step.add(1.0, &self.correction);
        }
        self.fill_slopes();
    }

    fn fill_slopes(&mut self) {
        let (bounds, rows) = self.columns.slope.split_at_mut(self.inequalities.bounds.len());
        for (bound, slope) in self.inequalities.bounds.iter().zip(bounds) {
            *slope = bound.slope(&self.step);
        }
        let (rows, trajectories) = rows.split_at_mut(self.inequalities.rows.len());
        for (row, slope) in self.inequalities.rows.iter().zip(rows) {
            *slope = row.slope(&self.step.states);
        }
        for (expanded, slope) in self.trajectory_rows.iter().zip(trajectories) {
            *slope = -expanded.dot(&self.step, Self::VEHICLES);
        }
    }
}

/// Turns a step of the factored Hessian into one with the rows over whole trajectories.
fn correct(columns: &Columns, expanded: &[ExpandedTrajectoryRow], step: &mut Point, vehicles: usize) {
    for (expanded, weight) in expanded.iter().zip(&columns.weight[columns.len() - expanded.len()..]) {
        expanded.correct(*weight, step, vehicles);
    }
}
