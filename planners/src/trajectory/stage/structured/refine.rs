//! Iterative refinement of a Newton step.
//!
//! Near the optimum the weights `ω` of active rows grow without bound and the factorisation loses digits. The step `Δz` of
//! the inputs is then corrected by solving once more for what it leaves of stationarity,
//!
//! ```text
//! n_k = g_k + (H Δz)_k + A_{k+1}ᵀ n_{k+1},      ρ_k = g_{w,k} + (H Δz)_{w,k} + B_kᵀ n_k
//! ```
//!
//! with the same factors.

use super::columns::larger;
use super::memory::Memory;
use super::riccati::{PairHessian, VehicleHessian, pairs};
use super::rows::Point;
use crate::trajectory::stage::adjoint::curvature_gradient;
use crate::trajectory::stage::qp::StageQp;

impl<const W: usize> Memory<W> {
    /// Turns `gradient` into the residual of the Newton step: zero over states, `ρ` over inputs.
    pub(super) fn fill_newton_residual(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        add_product(qp, &self.hessians, &self.pairs, &self.step, &mut self.gradient);
        let weights = &self.columns.weight[self.columns.len() - self.trajectory_rows.len()..];
        for (expanded, weight) in self.trajectory_rows.iter().zip(weights) {
            expanded.add_gradient(weight * expanded.dot(&self.step, vehicles), &mut self.gradient, vehicles);
        }
        self.condense_gradient(qp);
    }

    /// Largest derivative of the Lagrangian over the inputs, where the iteration stands.
    pub(super) fn stationarity(&mut self, qp: &StageQp) -> f64 {
        self.fill_cost_gradient(qp);
        self.fill_gradient(true);
        self.condense_gradient(qp);
        self.gradient.inputs.as_flattened().iter().fold(0.0, |largest, slope| larger(slope.abs(), largest))
    }

    /// Condenses a gradient over states and inputs into one over inputs alone, the states following the dynamics. The entries of
    /// inputs that several futures share are added up in the first of them.
    fn condense_gradient(&mut self, qp: &StageQp) {
        let vehicles = Self::VEHICLES;
        for (i, stages) in qp.vehicles.iter().enumerate() {
            let mut carried = [0.0; 4];
            for k in (0..qp.horizon).rev() {
                let at = k * vehicles + i;
                let gradient = std::mem::take(&mut self.gradient.states[at]);
                let costate = std::array::from_fn(|axis| gradient[axis] + carried[axis]);
                let (state, input) = stages.jacobians[k].apply_transposed(&costate);
                carried = state;
                for axis in 0..2 {
                    self.gradient.inputs[at][axis] += input[axis];
                }
                if k < stages.first {
                    self.gradient.inputs[at] = [0.0; 2];
                }
            }
        }
        for futures in self.gradient.inputs.chunks_mut(vehicles).take(qp.shared_steps) {
            let (shared, others) = futures.split_at_mut(1);
            for other in others {
                let [acceleration, steering] = std::mem::take(other);
                shared[0] = [shared[0][0] + acceleration, shared[0][1] + steering];
            }
        }
    }
}

/// Adds `H Δz` to a gradient.
fn add_product(
    qp: &StageQp,
    hessians: &[VehicleHessian],
    coupling: &[PairHessian],
    step: &Point,
    gradient: &mut Point,
) {
    let vehicles = qp.vehicles.len();
    for (at, h) in hessians.iter().enumerate() {
        let ([x, y, t, v], [a, s]) = (step.states[at], step.inputs[at]);
        let [xx, xy, xt, yy, yt, tt] = h.pose;
        let products = [xx * x + xy * y + xt * t, xy * x + yy * y + yt * t, xt * x + yt * y + tt * t, h.speed * v];
        for axis in 0..4 {
            gradient.states[at][axis] += products[axis];
        }
        gradient.inputs[at][0] += h.input[0] * a;
        gradient.inputs[at][1] += h.input[1] * s;
    }
    let every_pair =
        (0..qp.horizon).flat_map(|k| pairs(vehicles).map(move |[i, j]| [k * vehicles + i, k * vehicles + j]));
    for ([i, j], [xx, xy, yy]) in every_pair.zip(coupling) {
        for (to, from) in [(i, j), (j, i)] {
            let [x, y, ..] = step.states[from];
            gradient.states[to][0] -= xx * x + xy * y;
            gradient.states[to][1] -= xy * x + yy * y;
        }
    }
    for (i, stages) in qp.vehicles.iter().enumerate() {
        for k in stages.first..qp.horizon {
            let at = k * vehicles + i;
            for axis in 0..2 {
                let before = if k > stages.first { step.inputs[at - vehicles][axis] } else { 0.0 };
                let pull = 2.0 * stages.change_weight(k, axis) * (step.inputs[at][axis] - before);
                gradient.inputs[at][axis] += pull;
                if k > stages.first {
                    gradient.inputs[at - vehicles][axis] -= pull;
                }
            }
            let before = if k > 0 { step.states[at - vehicles] } else { [0.0; 4] };
            let ([heading, speed], steering) = curvature_gradient(&stages.curvatures[k], &before, &step.inputs[at]);
            gradient.inputs[at][1] += steering;
            if k > 0 {
                gradient.states[at - vehicles][2] += heading;
                gradient.states[at - vehicles][3] += speed;
            }
        }
    }
}
