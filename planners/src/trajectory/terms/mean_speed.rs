//! Bounds on a vehicle's mean speed `v̄ = Σ_{t=0…N} v_t / (N + 1)` (eq. 8.14, 8.15): `lower − v̄ ≤ s` or `v̄ − upper ≤ s`.
//!
//! Linear, so the expansion is exact. Deviation from eq. 8.13: as printed the `N + 1` speeds are divided by `N`.

use super::shape::TrajectoryTerm;
use crate::State;
use crate::trajectory::cost::Violation;
use crate::trajectory::penalty::Penalty;
use crate::trajectory::stage::TrajectoryRow;

/// An interval for the mean speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanSpeed {
    /// Lower bound, if any \[m/s\].
    pub lower_mps: Option<f64>,
    /// Upper bound, if any \[m/s\].
    pub upper_mps: Option<f64>,
    /// What falling outside costs.
    pub penalty: Penalty,
}

/// One bound on the mean speed of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanSpeedBound {
    /// Whose mean speed.
    pub vehicle: usize,
    /// The bound \[m/s\].
    pub speed_mps: f64,
    /// Whether it is the upper one.
    pub is_upper: bool,
    /// What falling outside costs.
    pub penalty: Penalty,
}

impl MeanSpeed {
    /// The mean speed of `N + 1` states \[m/s\].
    pub fn of(states: &[State]) -> f64 {
        states.iter().map(|state| state.speed_mps).sum::<f64>() / states.len() as f64
    }

    /// The bounds that exist: the lower, then the upper one.
    pub fn bounds(&self, vehicle: usize) -> impl Iterator<Item = MeanSpeedBound> + use<> {
        let penalty = self.penalty;
        let bounds = [(self.lower_mps, false), (self.upper_mps, true)];
        bounds.into_iter().filter_map(move |(bound, is_upper)| {
            let speed_mps = bound?;
            Some(MeanSpeedBound { vehicle, speed_mps, is_upper, penalty })
        })
    }
}

impl TrajectoryTerm for MeanSpeedBound {
    fn vehicle(&self) -> usize {
        self.vehicle
    }

    fn penalty(&self) -> Penalty {
        self.penalty
    }

    fn violation(&self) -> Option<Violation> {
        Some(Violation::MeanSpeed)
    }

    fn excess(&self, states: &[State]) -> f64 {
        let mean = MeanSpeed::of(states);
        if self.is_upper { mean - self.speed_mps } else { self.speed_mps - mean }
    }

    fn expand(&self, states: &[State], row: &mut TrajectoryRow) {
        let sign = if self.is_upper { 1.0 } else { -1.0 };
        row.gradients.fill([0.0, 0.0, sign / states.len() as f64]);
        row.bends.fill(0.0);
    }
}
