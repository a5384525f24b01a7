//! Tracking: `Σ_{t=1…N} ‖x_t − target_t‖²_Q` with diagonal `Q` in the axes of the vehicle's road (eq. 6.6).
//!
//! Gradient `2 Q (x − target)`, Hessian `2 Q`, both turned into the axes of the world.
//!
//! Deviation from eq. 6.6: as printed the sum runs over `t = 0…N−1`, which leaves the last input idle.

use super::shape::StateCostTerm;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::stage::StateCost;
use crate::{Axes, State};

/// The tracking cost of one vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Tracking {
    /// Index of the vehicle whose states it concerns.
    pub vehicle: usize,
    /// Diagonal of `Q` on (position along `axes`, across them, θ, v).
    pub weights: [f64; 4],
    /// The axes in which `Q` is diagonal: those of the vehicle's road.
    pub axes: Axes,
    /// Desired state at `t = 1…N`; `N` long.
    pub targets: Vec<State>,
}

impl Tracking {
    /// The deviation from the desired state at a stage, on (along, across, θ, v).
    fn deviation(&self, stage: usize, state: &State) -> [f64; 4] {
        let (state, target) = (state.to_array(), self.targets[stage].to_array());
        let [x, y, heading, speed] = std::array::from_fn(|i| state[i] - target[i]);
        let [along, across] = self.axes.components([x, y]);
        [along, across, heading, speed]
    }
}

impl StateCostTerm for Tracking {
    fn vehicle(&self) -> usize {
        self.vehicle
    }

    fn add_value(&self, stage: usize, iterate: &Iterate, total: &mut f64) {
        let state = &iterate.states[self.vehicle][stage + 1];
        let deviation = self.deviation(stage, state);
        for i in 0..4 {
            *total += self.weights[i] * deviation[i].powi(2);
        }
    }

    fn add_expansion(&self, stage: usize, iterate: &Iterate, cost: &mut StateCost, _concave: &mut [f64; 3]) {
        let state = &iterate.states[self.vehicle][stage + 1];
        let (deviation, weights) = (self.deviation(stage, state), self.weights);
        let [along, across, heading, speed] = std::array::from_fn(|i| 2.0 * weights[i] * deviation[i]);
        let [x, y] = self.axes.vector([along, across]);
        let [xx, xy, yy] = self.axes.matrix([2.0 * weights[0], 0.0, 2.0 * weights[1]]);
        for (sum, slope) in cost.gradient.iter_mut().zip([x, y, heading, speed]) {
            *sum += slope;
        }
        for (sum, bend) in cost.hessian.iter_mut().zip([xx, yy, 2.0 * weights[2], 2.0 * weights[3]]) {
            *sum += bend;
        }
        cost.cross += xy;
    }
}
