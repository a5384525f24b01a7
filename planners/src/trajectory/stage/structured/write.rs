//! From the columns back to the shape of a solution.

use super::memory::Memory;
use crate::trajectory::stage::solution::StageSolution;

impl<const W: usize> Memory<W> {
    /// Copies point and multipliers into the solution's shape.
    pub(super) fn write(&self, solution: &mut StageSolution) {
        let vehicles = Self::VEHICLES;
        for (at, (state, input)) in self.point.states.iter().zip(&self.point.inputs).enumerate() {
            solution.states[at % vehicles][at / vehicles] = *state;
            solution.inputs[at % vehicles][at / vehicles] = *input;
        }
        solution.bound_multipliers.iter_mut().for_each(|bounds| bounds.fill([[0.0; 2]; 3]));
        let (bounds, rows) = self.columns.multiplier.split_at(self.inequalities.bounds.len());
        for (bound, multiplier) in self.inequalities.bounds.iter().zip(bounds) {
            let side = usize::from(bound.sign < 0.0);
            solution.bound_multipliers[bound.at % vehicles][bound.at / vehicles][bound.quantity][side] = *multiplier;
        }
        solution.row_multipliers.iter_mut().for_each(|multipliers| multipliers.fill(0.0));
        let (rows, trajectories) = rows.split_at(self.inequalities.rows.len());
        for (row, multiplier) in self.inequalities.rows.iter().zip(rows) {
            solution.row_multipliers[row.block][row.at / vehicles] = *multiplier;
        }
        solution.trajectory_multipliers.copy_from_slice(trajectories);
    }
}
