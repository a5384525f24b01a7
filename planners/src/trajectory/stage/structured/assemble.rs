//! Second derivatives and gradient of the QP subproblem, with what the inequalities add to them.

use super::memory::Memory;
use super::riccati::{PairHessian, VehicleHessian, pair_index, pairs_among};
use crate::trajectory::stage::adjoint::curvature_gradient;
use crate::trajectory::stage::qp::{Row, StageQp};

impl<const W: usize> Memory<W> {
    /// Assembles the second derivatives with the weights `ω`.
    pub(super) fn assemble(&mut self, qp: &StageQp) {
        self.hessians.clone_from(&self.smooth_hessians);
        self.pairs.clone_from(&self.smooth_pairs);
        let (bounds, rows) = self.columns.weight.split_at(self.inequalities.bounds.len());
        for (bound, weight) in self.inequalities.bounds.iter().zip(bounds) {
            let hessian = &mut self.hessians[bound.at];
            match bound.quantity {
                2 => hessian.speed += weight,
                axis => hessian.input[axis] += weight,
            }
        }
        for (row, weight) in self.inequalities.rows.iter().zip(rows) {
            let [x, y, t] = row.gradient;
            if let Some(other) = row.other {
                let position = [weight * x * x, weight * x * y, weight * y * y];
                add_pair(&mut self.hessians, &mut self.pairs, Self::VEHICLES, [row.at, other], position);
            } else {
                let pose = &mut self.hessians[row.at].pose;
                for (value, product) in pose.iter_mut().zip([x * x, x * y, x * t, y * y, y * t, t * t]) {
                    *value += weight * product;
                }
            }
        }
        let multipliers = &self.columns.multiplier[self.columns.len() - self.trajectory_rows.len()..];
        for (row, multiplier) in qp.trajectory_rows.iter().zip(multipliers) {
            for (k, beta) in row.bends.iter().enumerate() {
                let pose = &mut self.hessians[k * Self::VEHICLES + row.vehicle].pose;
                pose[0] += 2.0 * multiplier * beta;
                pose[3] += 2.0 * multiplier * beta;
            }
        }
    }

    /// The smooth cost's second derivatives and the rows' own curvature.
    pub(super) fn fill_smooth_hessians(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        self.smooth_hessians.clear();
        self.smooth_pairs.clear();
        self.smooth_pairs.resize(qp.horizon * pairs_among(vehicles), [0.0; 3]);
        for k in 0..qp.horizon {
            for stages in &qp.vehicles {
                let cost = &stages.state_costs[k];
                let ([xx, xy, yy], [.., heading, speed]) = (cost.position_hessian(), cost.hessian);
                let [xt, yt] = cost.heading_cross;
                let pose = [xx, xy, xt, yy, yt, heading];
                let input = [0, 1].map(|axis| stages.damping(qp.damping, axis) + self.input_regularization);
                self.smooth_hessians.push(VehicleHessian { pose, speed, input });
            }
        }
        for block in &qp.blocks {
            for (k, row) in block.rows.iter().enumerate().filter(|(_, row)| row.active) {
                let ([xx, xy, _, yy, ..], at) = (row.curvature, k * vehicles + block.vehicle);
                if let Some(other) = block.other {
                    let indices = [at, k * vehicles + other];
                    add_pair(&mut self.smooth_hessians, &mut self.smooth_pairs, vehicles, indices, [xx, xy, yy]);
                } else {
                    let pose = &mut self.smooth_hessians[at].pose;
                    pose.iter_mut().zip(row.curvature).for_each(|(value, entry)| *value += entry);
                }
            }
        }
    }

    /// Gradient of the smooth cost (with curvature) at the point.
    pub(super) fn fill_cost_gradient(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        self.cost_gradient.clear(qp.horizon * vehicles);
        let (states, inputs) = (&self.point.states, &self.point.inputs);
        for (i, stages) in qp.vehicles.iter().enumerate() {
            for k in 0..qp.horizon {
                let at = k * vehicles + i;
                let gradient = stages.state_costs[k].gradient_at(&states[at]);
                for axis in 0..4 {
                    self.cost_gradient.states[at][axis] += gradient[axis];
                }
                if k < stages.first {
                    continue;
                }
                for axis in 0..2 {
                    let before = if k > stages.first { inputs[at - vehicles][axis] } else { 0.0 };
                    let change = stages.changes[k][axis] + inputs[at][axis] - before;
                    let pull = 2.0 * stages.change_weight(k, axis) * change;
                    self.cost_gradient.inputs[at][axis] += pull + stages.damping(qp.damping, axis) * inputs[at][axis];
                    if k > stages.first {
                        self.cost_gradient.inputs[at - vehicles][axis] -= pull;
                    }
                }
                let before = if k > 0 { states[at - vehicles] } else { [0.0; 4] };
                let ([heading, speed], steering) = curvature_gradient(&stages.curvatures[k], &before, &inputs[at]);
                self.cost_gradient.inputs[at][1] += steering;
                if k > 0 {
                    self.cost_gradient.states[at - vehicles][2] += heading;
                    self.cost_gradient.states[at - vehicles][3] += speed;
                }
            }
        }
        self.add_row_curvature(qp);
    }

    /// The gradient of the Lagrangian over states and inputs: with the multipliers as they are (`with_multipliers`), or with those
    /// that the targets imply (the right-hand side of the Newton step).
    pub(super) fn fill_gradient(&mut self, with_multipliers: bool) {
        self.gradient.states.clone_from(&self.cost_gradient.states);
        self.gradient.inputs.clone_from(&self.cost_gradient.inputs);
        let multipliers = if with_multipliers { &self.columns.multiplier } else { &self.columns.condensed_multiplier };
        let (pulls, row_pulls) = multipliers.split_at(self.inequalities.bounds.len());
        for (bound, pull) in self.inequalities.bounds.iter().zip(pulls) {
            bound.add_gradient(-pull, &mut self.gradient);
        }
        for (row, pull) in self.inequalities.rows.iter().zip(row_pulls) {
            row.add_gradient(-pull, &mut self.gradient.states);
        }
        for (expanded, pull) in self.trajectory_rows.iter().zip(&row_pulls[self.inequalities.rows.len()..]) {
            expanded.add_gradient(*pull, &mut self.gradient, Self::VEHICLES);
        }
    }

    fn add_row_curvature(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        // Most rows do not bend: all of a Gauss-Newton step, and otherwise those without a multiplier.
        let bends = |row: &Row| row.active && row.curvature != [0.0; 6];
        for block in &qp.blocks {
            for (k, row) in block.rows.iter().enumerate().filter(|(_, row)| bends(row)) {
                let (at, other) = (k * vehicles + block.vehicle, block.other.map(|other| k * vehicles + other));
                let own = self.point.states[at];
                let origin = other.map_or([0.0; 4], |other| self.point.states[other]);
                let pull = row.curvature_gradient([own[0] - origin[0], own[1] - origin[1], own[2]]);
                let gradients = &mut self.cost_gradient.states;
                gradients[at][2] += pull[2];
                for axis in 0..2 {
                    gradients[at][axis] += pull[axis];
                    if let Some(other) = other {
                        gradients[other][axis] -= pull[axis];
                    }
                }
            }
        }
    }
}

/// Adds a Hessian over the difference of two positions.
#[inline(always)]
fn add_pair(
    hessians: &mut [VehicleHessian],
    pairs: &mut [PairHessian],
    vehicles: usize,
    [at, other]: [usize; 2],
    position: [f64; 3],
) {
    for index in [at, other] {
        let pose = &mut hessians[index].pose;
        pose[0] += position[0];
        pose[1] += position[1];
        pose[3] += position[2];
    }
    let pair = at / vehicles * pairs_among(vehicles) + pair_index(at % vehicles, other % vehicles);
    for (value, add) in pairs[pair].iter_mut().zip(position) {
        *value += add;
    }
}
