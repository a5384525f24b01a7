//! An independent check of optimality: the Karush-Kuhn-Tucker residual of a stage problem, computed from the problem and
//! the claimed multipliers and not from the solver's own word.
//!
//! At deviations of zero it is the residual of the nonlinear problem at the iterate.

use super::adjoint::{Costates, curvature_gradient, fill_costates};
use super::qp::{Row, RowBlock, StageQp};
use super::solution::StageSolution;
use crate::trajectory::penalty::Penalty;

/// Largest violation of each optimality condition.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Derivative of the Lagrangian over the inputs.
    pub stationarity: f64,
    /// Boxes, rows and dynamics.
    pub primal: f64,
    /// Negative multipliers.
    pub dual: f64,
    /// Multiplier times distance to its bound.
    pub complementarity: f64,
}

impl Residual {
    /// The largest of the four.
    pub fn largest(&self) -> f64 {
        self.stationarity.max(self.primal).max(self.dual).max(self.complementarity)
    }

    /// A row of value `c`: hard (`c ≥ 0`), or soft with the violation that its multiplier implies. From
    /// `λ = linear + 2·quadratic·s` for `s > 0`, else `λ ≤ linear`, follows `s = (λ − linear)₊/(2·quadratic)`; without
    /// a quadratic weight `s` is the violation itself and costs `linear − λ ≥ 0` where it is not zero.
    fn row(&mut self, value: f64, multiplier: f64, penalty: Option<Penalty>) {
        match penalty {
            None => self.inequality(value, multiplier),
            Some(p) if p.quadratic > 0.0 => {
                let violation = ((multiplier - p.linear) / (2.0 * p.quadratic)).max(0.0);
                self.inequality(value + violation, multiplier);
                // A violation costs its linear weight, and only λ of that is accounted for.
                self.complementarity = self.complementarity.max((p.linear - multiplier).max(0.0) * (-value).max(0.0));
            }
            Some(p) => {
                let violation = (-value).max(0.0);
                self.inequality(value + violation, multiplier);
                self.inequality(violation, p.linear - multiplier);
            }
        }
    }

    fn inequality(&mut self, slack: f64, multiplier: f64) {
        self.primal = self.primal.max(-slack);
        self.dual = self.dual.max(-multiplier);
        self.complementarity = self.complementarity.max((multiplier * slack).abs());
    }
}

/// The residual of `solution` in `qp`.
pub fn residual(qp: &StageQp, solution: &StageSolution) -> Residual {
    residual_in(qp, solution, &mut Costates::new())
}

/// The residual of `solution` in `qp`, with memory for the costates.
pub fn residual_in(qp: &StageQp, solution: &StageSolution, costates: &mut Costates) -> Residual {
    let mut residual = Residual::default();
    fill_costates(qp, solution, costates);
    for (vehicle, costates) in costates.iter().enumerate() {
        vehicle_residual(qp, solution, vehicle, costates, &mut residual);
    }
    for (block, multipliers) in qp.blocks.iter().zip(&solution.row_multipliers) {
        for (k, (row, multiplier)) in block.rows.iter().zip(multipliers).enumerate() {
            if row.active {
                residual.row(row_value(block, row, solution, k), *multiplier, block.penalty);
            }
        }
    }
    for (row, multiplier) in qp.trajectory_rows.iter().zip(&solution.trajectory_multipliers) {
        let value = row.value_at(solution.states[row.vehicle].iter());
        residual.row(-value, *multiplier, Some(row.penalty));
    }
    residual
}

/// `c + ∇c·p` of a row at the solution's deviations.
pub(crate) fn row_value(block: &RowBlock, row: &Row, solution: &StageSolution, k: usize) -> f64 {
    let own = solution.states[block.vehicle][k];
    let other = block.other.map_or([0.0; 4], |other| solution.states[other][k]);
    row.value + row.gradient[0] * (own[0] - other[0]) + row.gradient[1] * (own[1] - other[1]) + row.gradient[2] * own[2]
}

fn vehicle_residual(
    qp: &StageQp,
    solution: &StageSolution,
    vehicle: usize,
    costates: &[[f64; 4]],
    residual: &mut Residual,
) {
    let stages = &qp.vehicles[vehicle];
    let (inputs, states) = (&solution.inputs[vehicle], &solution.states[vehicle]);
    for k in 0..qp.horizon {
        let before = solution.state_before(vehicle, k);
        let moved = stages.jacobians[k].apply(&before, &inputs[k]);
        for axis in 0..4 {
            residual.primal = residual.primal.max((moved[axis] - states[k][axis]).abs());
        }
        let [acceleration, steering, speed] = solution.bound_multipliers[vehicle][k];
        if k >= stages.first {
            let bounds = stages.speed_boxes[k];
            residual.inequality(states[k][3] - bounds.lower, speed[0]);
            residual.inequality(bounds.upper - states[k][3], speed[1]);
        }
        if k < stages.first {
            continue;
        }
        let (_, from_dynamics) = stages.jacobians[k].apply_transposed(&costates[k]);
        let (_, from_curvature) = curvature_gradient(&stages.curvatures[k], &before, &inputs[k]);
        for (axis, [lower, upper]) in [acceleration, steering].into_iter().enumerate() {
            let bounds = stages.input_boxes[k][axis];
            residual.inequality(inputs[k][axis] - bounds.lower, lower);
            residual.inequality(bounds.upper - inputs[k][axis], upper);
            let mut gradient = from_dynamics[axis] + upper - lower + stages.damping(qp.damping, axis) * inputs[k][axis];
            gradient += 2.0 * stages.change_weights[axis] * stages.change(inputs, k, axis);
            if k + 1 < qp.horizon {
                gradient -= 2.0 * stages.change_weights[axis] * stages.change(inputs, k + 1, axis);
            }
            if axis == 1 {
                gradient += from_curvature;
            }
            residual.stationarity = residual.stationarity.max(gradient.abs());
        }
    }
}
