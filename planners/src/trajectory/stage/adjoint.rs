//! Costates: how much the Lagrangian would change if a state could be moved.
//!
//! With `n_k` the multiplier of `d_{k+1} = A_k d_k + B_k w_k`, stationarity in `d_{k+1}` is the backward recursion
//!
//! ```text
//! n_k = ∂ℓ_k/∂d_{k+1} − Σ λ ∇c − (λ_lower − λ_upper) e_v + Σ κ (b_k + 2β p_{k+1}) + A_{k+1}ᵀ n_{k+1}
//! ```
//!
//! and stationarity in `w_k` needs `B_kᵀ n_k` plus the input's own terms to vanish.

use super::qp::StageQp;
use super::solution::StageSolution;
use crate::vehicle::DynamicsCurvature;

impl StageSolution {
    /// Sets the deviations to zero and keeps the multipliers: the point is now the iterate itself.
    pub fn rest(&mut self) {
        self.inputs.iter_mut().for_each(|inputs| inputs.fill([0.0; 2]));
        self.states.iter_mut().for_each(|states| states.fill([0.0; 4]));
    }

    /// The deviation `d_k` of a vehicle's state before stage `k`; zero at the first.
    pub(crate) fn state_before(&self, vehicle: usize, k: usize) -> [f64; 4] {
        if k == 0 { [0.0; 4] } else { self.states[vehicle][k - 1] }
    }
}

/// `C (d, w)`: the gradient of the dynamics' curvature over `(θ, v)` and `δ`.
pub(crate) fn curvature_gradient(c: &DynamicsCurvature, d: &[f64; 4], w: &[f64; 2]) -> ([f64; 2], f64) {
    let (heading, speed, steering) = (d[2], d[3], w[1]);
    (
        [
            c.heading_heading * heading + c.heading_speed * speed + c.heading_steering * steering,
            c.heading_speed * heading + c.speed_steering * steering,
        ],
        c.heading_steering * heading + c.speed_steering * speed + c.steering_steering * steering,
    )
}

/// Costates `n_k` of every vehicle, `N` of them each.
pub type Costates = Vec<Vec<[f64; 4]>>;

/// Writes the costates at the solution's deviations and multipliers; `costates` keeps its allocations.
pub fn fill_costates(qp: &StageQp, at: &StageSolution, costates: &mut Costates) {
    fill_state_gradients(qp, at, costates);
    for (i, stages) in qp.vehicles.iter().enumerate() {
        for k in (0..qp.horizon.saturating_sub(1)).rev() {
            let (from_next, _) = stages.jacobians[k + 1].apply_transposed(&costates[i][k + 1]);
            for (value, carried) in costates[i][k].iter_mut().zip(from_next) {
                *value += carried;
            }
        }
    }
}

/// Writes the derivative of the Lagrangian over `d_{k+1}` without the dynamics.
fn fill_state_gradients(qp: &StageQp, at: &StageSolution, gradients: &mut Costates) {
    gradients.resize_with(qp.vehicles.len(), Vec::new);
    for (vehicle, gradients) in gradients.iter_mut().enumerate() {
        gradients.clear();
        gradients.extend((0..qp.horizon).map(|k| vehicle_gradient(qp, at, vehicle, k)));
    }
    for (block, multipliers) in qp.blocks.iter().zip(&at.row_multipliers) {
        for (k, (row, multiplier)) in block.rows.iter().zip(multipliers).enumerate() {
            if !row.active {
                continue;
            }
            let own = at.states[block.vehicle][k];
            let other = block.other.map_or([0.0; 4], |other| at.states[other][k]);
            let (x, y) = (own[0] - other[0], own[1] - other[1]);
            let curved = row.curvature_gradient([x, y, own[2]]);
            let pull: [f64; 3] = std::array::from_fn(|axis| curved[axis] - multiplier * row.gradient[axis]);
            for axis in 0..3 {
                gradients[block.vehicle][k][axis] += pull[axis];
            }
            if let Some(other) = block.other {
                gradients[other][k][0] -= pull[0];
                gradients[other][k][1] -= pull[1];
            }
        }
    }
    for (row, multiplier) in qp.trajectory_rows.iter().zip(&at.trajectory_multipliers) {
        for k in 0..qp.horizon {
            let [x, y, speed] = row.slope_at(k, &at.states[row.vehicle][k]);
            let gradient = &mut gradients[row.vehicle][k];
            gradient[0] += multiplier * x;
            gradient[1] += multiplier * y;
            gradient[3] += multiplier * speed;
        }
    }
}

/// The part of [`fill_state_gradients`] that comes from the vehicle's own cost and speed box.
fn vehicle_gradient(qp: &StageQp, at: &StageSolution, vehicle: usize, k: usize) -> [f64; 4] {
    let stages = &qp.vehicles[vehicle];
    let (cost, d) = (&stages.state_costs[k], at.states[vehicle][k]);
    let mut gradient = cost.gradient_at(&d);
    let [lower, upper] = at.bound_multipliers[vehicle][k][2];
    gradient[3] += upper - lower;
    if k + 1 < qp.horizon {
        let ([heading, speed], _) = curvature_gradient(&stages.curvatures[k + 1], &d, &at.inputs[vehicle][k + 1]);
        gradient[2] += heading;
        gradient[3] += speed;
    }
    gradient
}
