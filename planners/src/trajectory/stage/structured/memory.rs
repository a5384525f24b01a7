//! What the parts of one iteration share: the inequalities, the second derivatives and gradients, and where the iteration
//! stands.

use super::columns::Columns;
use super::riccati::{PairHessian, VehicleHessian};
use super::rows::{Inequalities, Point};
use super::trajectory_row::ExpandedTrajectoryRow;
use crate::trajectory::stage::qp::StageQp;

/// The numbers of one iteration with `W/2` vehicles.
#[derive(Clone, Debug, Default)]
pub(super) struct Memory<const W: usize> {
    pub inequalities: Inequalities,
    pub columns: Columns,
    pub hessians: Vec<VehicleHessian>,
    pub pairs: Vec<PairHessian>,
    /// The part of them that stays the same.
    pub smooth_hessians: Vec<VehicleHessian>,
    pub smooth_pairs: Vec<PairHessian>,
    /// Added to the Hessian over the inputs where it is singular but for rounding; steps are then a little short.
    pub input_regularization: f64,
    /// Where the iteration stands.
    pub point: Point,
    /// Its next step.
    pub step: Point,
    /// Gradient of the smooth cost at the point.
    pub cost_gradient: Point,
    /// The same with the multipliers of the inequalities.
    pub gradient: Point,
    /// The rows over whole trajectories at the point.
    pub trajectory_rows: Vec<ExpandedTrajectoryRow>,
}

impl<const W: usize> Memory<W> {
    pub(super) const VEHICLES: usize = W / 2;

    /// Every inequality at the point, and the gradients of rows over whole trajectories.
    pub(super) fn refresh_values(&mut self, qp: &StageQp) {
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

    /// Every inequality's slope along the step.
    pub(super) fn fill_slopes(&mut self) {
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
