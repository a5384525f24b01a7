//! Bounds on a vehicle's mean speed: two linear rows over its whole trajectory (eq. 8.14, 8.15).

use crate::State;
use crate::trajectory::penalty::Penalty;
use crate::trajectory::stage::TrajectoryRow;

/// Bounds on the mean speed `v̄ = Σ_{t=0…N} v_t / (N + 1)`: `lower − v̄ ≤ s` and `v̄ − upper ≤ s`.
///
/// Deviation from eq. 8.13: as printed the `N + 1` speeds are divided by `N`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanSpeed {
    /// Lower bound, if any \[m/s\].
    pub lower_mps: Option<f64>,
    /// Upper bound, if any \[m/s\].
    pub upper_mps: Option<f64>,
    /// What falling outside costs.
    pub penalty: Penalty,
}

impl MeanSpeed {
    /// The mean speed of `N + 1` states.
    pub fn of(states: &[State]) -> f64 {
        states.iter().map(|state| state.speed_mps).sum::<f64>() / states.len() as f64
    }

    /// Left sides of the rows that exist, each at most 0 when it holds, with the sign of the mean speed in it.
    pub(crate) fn values(&self, states: &[State]) -> impl Iterator<Item = (f64, f64)> {
        let mean = MeanSpeed::of(states);
        let rows = [self.lower_mps.map(|lower| (lower - mean, -1.0)), self.upper_mps.map(|upper| (mean - upper, 1.0))];
        rows.into_iter().flatten()
    }

    /// The rows at a trajectory of `vehicle`; they are linear, so exact.
    pub(crate) fn rows(&self, vehicle: usize, states: &[State]) -> impl Iterator<Item = TrajectoryRow> {
        let (steps, penalty) = (states.len() - 1, self.penalty);
        self.values(states).map(move |(value, sign)| TrajectoryRow {
            vehicle,
            value,
            gradients: vec![[0.0, 0.0, sign / (steps + 1) as f64]; steps],
            bends: vec![0.0; steps],
            penalty,
        })
    }
}
