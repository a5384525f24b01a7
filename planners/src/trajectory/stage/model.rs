//! The value of a stage problem's model: what a step is predicted to change.

use super::adjoint::curvature_gradient;
use super::kkt::row_value;
use super::qp::StageQp;
use super::solution::StageSolution;
use crate::trajectory::penalty::Penalty;

impl StageQp {
    /// How the cost of the model changes from the iterate (all deviations zero) to the solution; negative for a
    /// decrease. Hard rows count nothing.
    pub fn change(&self, solution: &StageSolution) -> f64 {
        let vehicles: f64 = (0..self.vehicles.len()).map(|i| self.vehicle_change(solution, i)).sum();
        let rows: f64 = (0..self.blocks.len()).map(|i| self.block_change(solution, i)).sum();
        let trajectories = self.trajectory_rows.iter().map(|row| {
            let after = row.value_at(solution.states[row.vehicle].iter());
            row.penalty.cost(-after) - row.penalty.cost(-row.value)
        });
        vehicles + rows + trajectories.sum::<f64>()
    }

    /// `Σ linear·s` after the step, as the rows' linear model has it, and the largest `λ/linear` of its multipliers.
    pub(crate) fn linear_penalties(&self, solution: &StageSolution) -> (f64, f64) {
        let (mut penalties, mut share) = (0.0, 0.0_f64);
        let mut add = |penalty: Penalty, value: f64, multiplier: f64| {
            if penalty.linear > 0.0 {
                penalties += penalty.linear * (-value).max(0.0);
                share = share.max(multiplier / penalty.linear);
            }
        };
        for (block, multipliers) in self.blocks.iter().zip(&solution.row_multipliers) {
            let Some(penalty) = block.penalty else { continue };
            for (k, (row, multiplier)) in
                block.rows.iter().zip(multipliers).enumerate().filter(|(_, (row, _))| row.active)
            {
                add(penalty, row_value(block, row, solution, k), *multiplier);
            }
        }
        (penalties, share)
    }

    fn vehicle_change(&self, solution: &StageSolution, vehicle: usize) -> f64 {
        let stages = &self.vehicles[vehicle];
        let (inputs, states) = (&solution.inputs[vehicle], &solution.states[vehicle]);
        let mut change = 0.0;
        for k in 0..self.horizon {
            let (cost, d) = (&stages.state_costs[k], states[k]);
            let after = cost.gradient_at(&d);
            for i in 0..4 {
                change += 0.5 * (cost.gradient[i] + after[i]) * d[i];
            }
            if k >= stages.first {
                for axis in 0..2 {
                    let (old, new) = (stages.changes[k][axis], stages.change(inputs, k, axis));
                    change += stages.change_weight(k, axis) * (new * new - old * old);
                }
            }
            for axis in 0..2 {
                change += 0.5 * stages.damping(self.damping, axis) * inputs[k][axis] * inputs[k][axis];
            }
            let before = solution.state_before(vehicle, k);
            let ([heading, speed], steering) = curvature_gradient(&stages.curvatures[k], &before, &inputs[k]);
            change += 0.5 * (heading * before[2] + speed * before[3] + steering * inputs[k][1]);
        }
        change
    }

    fn block_change(&self, solution: &StageSolution, index: usize) -> f64 {
        let block = &self.blocks[index];
        let cost = |value: f64| block.penalty.map_or(0.0, |penalty: Penalty| penalty.cost(value));
        let mut change = 0.0;
        for (k, row) in block.rows.iter().enumerate().filter(|(_, row)| row.active) {
            change += cost(row_value(block, row, solution, k)) - cost(row.value);
            let own = solution.states[block.vehicle][k];
            let other = block.other.map_or([0.0; 4], |other| solution.states[other][k]);
            let (x, y) = (own[0] - other[0], own[1] - other[1]);
            let ([xx, xy, xt, yy, yt, tt], turn) = (row.curvature, own[2]);
            let mixed = 2.0 * turn * (xt * x + yt * y);
            change += 0.5 * (xx * x * x + 2.0 * xy * x * y + yy * y * y + tt * turn * turn + mixed);
        }
        change
    }
}
