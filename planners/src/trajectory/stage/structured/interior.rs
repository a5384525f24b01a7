//! The interior-point iteration (see the parent module for the equations).

use super::columns::{Columns, Start, larger};
use super::memory::Memory;
use super::riccati::Riccati;
use super::rows::Point;
use super::trajectory_row::ExpandedTrajectoryRow;
use crate::trajectory::stage::qp::{Hessian, Reach, StageQp};
use crate::trajectory::stage::solution::StageSolution;
use crate::trajectory::stage::solver::{StageError, StageSolver, StageStatus};

/// Tolerance on the dual residual as a share of its start, per tolerance on everything else.
const DUAL_TOLERANCE_RATIO: f64 = 1e-3;
/// Largest residual that is accepted where rounding stops the iteration above the tolerance.
const ACCEPTED_RESIDUAL: f64 = 1e-7;
/// Below this mean complementarity Newton steps are refined: the factorisation has lost digits that matter.
const REFINEMENT_COMPLEMENTARITY: f64 = 1e-4;
/// The centring aims at no complementarity below this share of the tolerance.
const MIN_CENTRING_RATIO: f64 = 1e-2;
/// Weight on the inputs where the Hessian is singular but for rounding ([`Memory::input_regularization`]).
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
            count => Err(StageError::Unsolved { status: StageStatus::TooManyVehicles { count }, iterations: 0 }),
        }
    }
}

/// The solver of problems with `W/2` vehicles; nothing is allocated once its memory has its size.
#[derive(Clone, Debug, Default)]
struct Interior<const W: usize, const Z: usize> {
    memory: Memory<W>,
    riccati: Riccati<W, Z>,
    /// What refinement adds to a step.
    correction: Point,
}

impl<const W: usize, const Z: usize> Interior<W, Z> {
    const VEHICLES: usize = Memory::<W>::VEHICLES;

    fn solve(&mut self, qp: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError> {
        let warm = warm && solution.fits(qp);
        solution.shape_like(qp);
        let mut iterations = 0;
        let start = if warm { Start::WARM } else { Start::COLD };
        let mut outcome = self.attempt(qp, solution, start, qp.reach.as_ref(), &mut iterations);
        if matches!(outcome, Err(StageError::Unsolved { .. })) && (warm || qp.reach.is_some()) {
            outcome = self.attempt(qp, solution, Start::COLD, None, &mut iterations);
        }
        if matches!(outcome, Err(StageError::Unsolved { .. })) && qp.hessian == Hessian::GaussNewton {
            self.memory.input_regularization = INPUT_REGULARIZATION;
            outcome = self.attempt(qp, solution, Start::COLD, None, &mut iterations);
            self.memory.input_regularization = 0.0;
        }
        solution.iterations = iterations;
        outcome?;
        self.memory.write(solution);
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
            Ok(()) if !self.memory.inequalities.excluded_rows_hold(&self.memory.point) => {
                unsolved(StageStatus::BeyondReach, *iterations)
            }
            // Without curvature every problem is convex: it was rounding.
            Err(StageError::NotConvex { stage }) if qp.hessian == Hessian::GaussNewton => {
                unsolved(StageStatus::NumericalError { stage }, *iterations)
            }
            outcome => outcome,
        }
    }

    /// Lists the inequalities, and sets slacks and multipliers at the iterate itself.
    fn begin(&mut self, qp: &StageQp, known: &StageSolution, start: Start, reach: Option<&Reach>) {
        let memory = &mut self.memory;
        memory.inequalities.fill(qp, known, reach);
        let rows = memory.inequalities.bounds.len() + memory.inequalities.rows.len() + qp.trajectory_rows.len();
        let hard = rows - memory.inequalities.weights.len();
        memory.columns.shape(hard, memory.inequalities.weights.iter().copied());
        memory.trajectory_rows.resize_with(qp.trajectory_rows.len(), ExpandedTrajectoryRow::default);
        memory.trajectory_rows.iter_mut().zip(&qp.trajectory_rows).for_each(|(expanded, row)| expanded.shape_like(row));
        memory.point.clear(qp.horizon * Self::VEHICLES);
        memory.fill_smooth_hessians(qp);
        memory.refresh_values(qp);
        memory.columns.initialize(start, &memory.inequalities.multipliers);
    }

    /// Newton's method with predictor and corrector until every residual is small.
    fn iterate(&mut self, qp: &StageQp, iterations: &mut usize) -> Result<(), StageError> {
        let count = self.memory.columns.pairs().max(1) as f64;
        // The dual residual is linear in the unknowns, so every step of length α leaves 1 − α of it.
        let (mut dual_share, mut polished) = (1.0, 0);
        for _ in 0..ITERATION_LIMIT {
            let (complementarity, primal) = self.memory.columns.update_residuals();
            if complementarity < qp.tolerance
                && primal < qp.tolerance
                && dual_share < DUAL_TOLERANCE_RATIO * qp.tolerance
            {
                // Multipliers come out of large weights with few digits; a step that is next to nothing cleans them.
                if polished == MAX_STEPS_WITHOUT_GAIN || self.memory.stationarity(qp) < STATIONARITY_TOLERANCE {
                    return Ok(());
                }
                polished += 1;
            }
            if !complementarity.is_finite() {
                break;
            }
            let largest = self.memory.columns.multiplier.iter().copied().fold(0.0, larger);
            if largest > INFEASIBLE_MULTIPLIER && primal > qp.tolerance.sqrt() {
                return Err(StageError::Infeasible { iterations: *iterations });
            }
            *iterations += 1;
            self.memory.columns.update_scaling();
            self.memory.assemble(qp);
            match self.riccati.factor(qp, &self.memory.hessians, &self.memory.pairs) {
                Err(_) if polished > 0 => return Ok(()),
                outcome => outcome?,
            }
            self.solve_for_trajectory_rows(qp);
            self.memory.fill_cost_gradient(qp);
            // Predictor: the affine direction, to a complementarity of zero.
            self.memory.columns.set_targets(0.0, false);
            self.solve_for_direction(qp, false);
            let affine = self.memory.columns.fill_direction();
            let share = if affine.ratio > 1.0 { 1.0 / affine.ratio } else { 1.0 };
            let left = complementarity + share * (affine.linear + share * affine.quadratic) / count;
            // Centring. Without any inequality there is nothing to centre; beyond the tolerance there is nothing to gain but rounding.
            let centring = if complementarity > 0.0 { (left / complementarity).powi(3) * complementarity } else { 0.0 };
            let centring = larger(centring, MIN_CENTRING_RATIO * qp.tolerance);
            // Corrector.
            self.memory.columns.set_targets(centring, true);
            self.solve_for_direction(qp, complementarity < REFINEMENT_COMPLEMENTARITY);
            let ratio = self.memory.columns.fill_direction().ratio;
            let boundary = 1.0 - complementarity.clamp(1e-6, 5e-3);
            let share = if ratio > boundary { boundary / ratio } else { 1.0 };
            self.memory.columns.take_step(share);
            self.memory.point.add(share, &self.memory.step);
            dual_share *= 1.0 - share;
            self.memory.refresh_values(qp);
        }
        let (complementarity, worst) = self.memory.columns.update_residuals();
        if complementarity < ACCEPTED_RESIDUAL && worst < ACCEPTED_RESIDUAL && dual_share < ACCEPTED_RESIDUAL {
            return Ok(());
        }
        let status = StageStatus::InsufficientProgress { residual: worst, dual_share };
        Err(StageError::Unsolved { status, iterations: *iterations })
    }

    /// `H⁻¹ v` of every row over a whole trajectory, for Sherman and Morrison.
    fn solve_for_trajectory_rows(&mut self, qp: &StageQp) {
        let memory = &mut self.memory;
        let weights = &memory.columns.weight[memory.columns.len() - memory.trajectory_rows.len()..];
        for index in 0..memory.trajectory_rows.len() {
            let (before, after) = memory.trajectory_rows.split_at_mut(index);
            let expanded = &mut after[0];
            memory.gradient.clear(qp.horizon * Self::VEHICLES);
            // The gradient −v makes the solve return H⁻¹ v.
            expanded.add_gradient(-1.0, &mut memory.gradient, Self::VEHICLES);
            expanded.response.clear(qp.horizon * Self::VEHICLES);
            self.riccati.solve(qp, &memory.gradient, &mut expanded.response);
            for (earlier, weight) in before.iter().zip(weights) {
                earlier.correct(*weight, &mut expanded.response, Self::VEHICLES);
            }
        }
    }

    /// The Newton direction towards the targets, refined if asked; leaves its slopes in the columns.
    fn solve_for_direction(&mut self, qp: &StageQp, refined: bool) {
        let memory = &mut self.memory;
        memory.fill_gradient(false);
        memory.step.states.resize(memory.gradient.states.len(), [0.0; 4]);
        memory.step.inputs.resize(memory.gradient.inputs.len(), [0.0; 2]);
        self.riccati.solve(qp, &memory.gradient, &mut memory.step);
        correct(&memory.columns, &memory.trajectory_rows, &mut memory.step, Self::VEHICLES);
        if refined {
            memory.fill_newton_residual(qp);
            self.correction.clear(qp.horizon * Self::VEHICLES);
            self.riccati.solve(qp, &memory.gradient, &mut self.correction);
            correct(&memory.columns, &memory.trajectory_rows, &mut self.correction, Self::VEHICLES);
            memory.step.add(1.0, &self.correction);
        }
        memory.fill_slopes();
    }
}

/// Turns a step of the factored Hessian into one with the rows over whole trajectories.
fn correct(columns: &Columns, expanded: &[ExpandedTrajectoryRow], step: &mut Point, vehicles: usize) {
    for (expanded, weight) in expanded.iter().zip(&columns.weight[columns.len() - expanded.len()..]) {
        expanded.correct(*weight, step, vehicles);
    }
}
