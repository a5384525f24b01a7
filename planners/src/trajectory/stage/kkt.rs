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
    /// Largest derivative of the Lagrangian over the inputs.
    pub stationarity: f64,
    /// Largest violation of boxes, rows and dynamics.
    pub primal: f64,
    /// Magnitude of the most negative multiplier.
    pub dual: f64,
    /// Largest product of a multiplier and the distance to its bound.
    pub complementarity: f64,
}

impl Residual {
    /// The largest of the four residuals.
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
    for vehicle in 0..qp.vehicles.len() {
        vehicle_residual(qp, solution, vehicle, &mut residual);
        for k in 0..qp.horizon {
            let gradient = |vehicle: usize| input_gradient(qp, solution, vehicle, k, &costates[vehicle][k]);
            let free = match (k < qp.shared_steps, vehicle) {
                (false, _) => gradient(vehicle),
                (true, 0) => {
                    (0..qp.vehicles.len()).map(gradient).fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]])
                }
                (true, _) => shared_difference(solution, vehicle, k),
            };
            let largest = free[0].abs().max(free[1].abs());
            residual.stationarity = residual.stationarity.max(largest);
        }
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

/// By how much the inputs of a vehicle differ from those of the first, where they are shared.
fn shared_difference(solution: &StageSolution, vehicle: usize, k: usize) -> [f64; 2] {
    std::array::from_fn(|axis| solution.inputs[vehicle][k][axis] - solution.inputs[0][k][axis])
}

/// Dynamics and boxes of one vehicle.
fn vehicle_residual(qp: &StageQp, solution: &StageSolution, vehicle: usize, residual: &mut Residual) {
    let stages = &qp.vehicles[vehicle];
    let (inputs, states) = (&solution.inputs[vehicle], &solution.states[vehicle]);
    for k in 0..qp.horizon {
        let before = solution.state_before(vehicle, k);
        let moved = stages.jacobians[k].apply(&before, &inputs[k]);
        for axis in 0..4 {
            residual.primal = residual.primal.max((moved[axis] - states[k][axis]).abs());
        }
        if k < stages.first {
            continue;
        }
        let [acceleration, steering, speed] = solution.bound_multipliers[vehicle][k];
        let bounds = stages.speed_boxes[k];
        residual.inequality(states[k][3] - bounds.lower, speed[0]);
        residual.inequality(bounds.upper - states[k][3], speed[1]);
        for (axis, [lower, upper]) in [acceleration, steering].into_iter().enumerate() {
            let bounds = stages.input_boxes[k][axis];
            residual.inequality(inputs[k][axis] - bounds.lower, lower);
            residual.inequality(bounds.upper - inputs[k][axis], upper);
        }
    }
}

/// The derivative of the Lagrangian over the inputs of one vehicle at stage `k`; zero where they are known.
fn input_gradient(qp: &StageQp, solution: &StageSolution, vehicle: usize, k: usize, costate: &[f64; 4]) -> [f64; 2] {
    let stages = &qp.vehicles[vehicle];
    if k < stages.first {
        return [0.0; 2];
    }
    let inputs = &solution.inputs[vehicle];
    let before = solution.state_before(vehicle, k);
    let (_, from_dynamics) = stages.jacobians[k].apply_transposed(costate);
    let (_, from_curvature) = curvature_gradient(&stages.curvatures[k], &before, &inputs[k]);
    std::array::from_fn(|axis| {
        let [lower, upper] = solution.bound_multipliers[vehicle][k][axis];
        let mut gradient = from_dynamics[axis] + upper - lower + stages.damping(qp.damping, axis) * inputs[k][axis];
        gradient += 2.0 * stages.change_weight(k, axis) * stages.change(inputs, k, axis);
        if k + 1 < qp.horizon {
            gradient -= 2.0 * stages.change_weight(k + 1, axis) * stages.change(inputs, k + 1, axis);
        }
        if axis == 1 {
            gradient += from_curvature;
        }
        gradient
    })
}
