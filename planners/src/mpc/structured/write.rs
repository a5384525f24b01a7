//! From the columns back to the shape of a solution.

use super::interior::Interior;
use super::rows::BOXES;
use crate::mpc::stage::{StageQp, StageSolution};

impl<const W: usize, const Z: usize> Interior<W, Z> {
    /// Copies point and multipliers into the solution's shape.
    pub(super) fn write(&self, qp: &StageQp, solution: &mut StageSolution) {
        let vehicles = Self::VEHICLES;
        for (at, (state, input)) in self.point.states.iter().zip(&self.point.inputs).enumerate() {
            solution.states[at % vehicles][at / vehicles] = *state;
            solution.inputs[at % vehicles][at / vehicles] = *input;
        }
        solution.bound_multipliers.iter_mut().for_each(|bounds| bounds.fill([[0.0; 2]; 3]));
        let (boxed, rows) = self.columns.multiplier.split_at(BOXES * self.inequalities.boxes.len());
        for (boxes, m) in self.inequalities.boxes.iter().zip(boxed.chunks_exact(BOXES)) {
            let bounds = &mut solution.bound_multipliers[boxes.at % vehicles][boxes.at / vehicles];
            *bounds = [[m[0], m[1]], [m[2], m[3]], [m[4], m[5]]];
        }
        solution.row_multipliers.iter_mut().for_each(|multipliers| multipliers.fill(0.0));
        let mut rows = rows.iter();
        for soft in [false, true] {
            for (block, multipliers) in qp.blocks.iter().zip(&mut solution.row_multipliers) {
                if block.penalty.is_some() != soft || !block.costs_something() {
                    continue;
                }
                for (row, multiplier) in block.rows.iter().zip(multipliers) {
                    if row.active {
                        *multiplier = rows.next().copied().unwrap_or_default();
                    }
                }
            }
        }
        for (multiplier, found) in solution.trajectory_multipliers.iter_mut().zip(rows) {
            *multiplier = *found;
        }
    }
}
