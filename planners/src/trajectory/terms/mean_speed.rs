//! Bounds on a vehicle's mean speed `v̄` (eq. 8.14, 8.15): `lower − v̄ ≤ s` or `v̄ − upper ≤ s`.
//!
//! ```text
//! v̄ = Σ_{t=0…N} v_t / (N + 1)                    of its speeds
//! v̄ = Σ_{t=0…N−1} τ_t·(p_{t+1} − p_t) / (N T)     along its road, τ_t the direction of the road at step t
//! ```
//!
//! Both are linear, so the expansion is exact. Deviations from eq. 8.13: as printed the `N + 1` speeds are divided by `N`; and what
//! says when a vehicle arrives is its way along the road. A bound on the speeds alone lets it weave in its lane, to be fast and
//! yet not arrive.

use super::shape::TrajectoryTerm;
use crate::State;
use crate::trajectory::cost::Violation;
use crate::trajectory::penalty::Penalty;
use crate::trajectory::stage::TrajectoryRow;

/// The speeds of which a mean is taken.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SpeedMeasure {
    /// The speeds of all states.
    #[default]
    Speeds,
    /// The progress along the road in each step, by time.
    AlongRoad {
        /// Unit vectors `τ_t` along the road; `N` long.
        directions: Vec<[f64; 2]>,
        /// Time step `T` \[s\].
        step_s: f64,
    },
}

/// An interval for the mean speed.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanSpeed {
    /// The speeds of which the mean is taken.
    pub measure: SpeedMeasure,
    /// Lower bound, if any \[m/s\].
    pub lower_mps: Option<f64>,
    /// Upper bound, if any \[m/s\].
    pub upper_mps: Option<f64>,
    /// Cost of a mean speed outside the bounds.
    pub penalty: Penalty,
}

/// One bound on the mean speed of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanSpeedBound {
    /// Index of the vehicle whose mean speed is bounded.
    pub vehicle: usize,
    /// The speeds of which the mean is taken.
    pub measure: SpeedMeasure,
    /// The bound \[m/s\].
    pub speed_mps: f64,
    /// Whether it is an upper bound.
    pub is_upper: bool,
    /// Cost of a mean speed outside the bounds.
    pub penalty: Penalty,
}

impl SpeedMeasure {
    /// The mean speed of `N + 1` states \[m/s\].
    pub fn evaluate(&self, states: &[State]) -> f64 {
        match self {
            SpeedMeasure::Speeds => states.iter().map(|state| state.speed_mps).sum::<f64>() / states.len() as f64,
            SpeedMeasure::AlongRoad { directions, step_s } => {
                let steps = states.windows(2).zip(directions);
                let way_m =
                    steps.map(|(pair, [x, y])| x * (pair[1].x_m - pair[0].x_m) + y * (pair[1].y_m - pair[0].y_m));
                way_m.sum::<f64>() / (directions.len() as f64 * step_s)
            }
        }
    }

    /// Its gradient over `(x, y, v)` of the state after step `k`, of `N + 1` states.
    fn gradient(&self, k: usize, states: usize) -> [f64; 3] {
        match self {
            SpeedMeasure::Speeds => [0.0, 0.0, 1.0 / states as f64],
            SpeedMeasure::AlongRoad { directions, step_s } => {
                let at = |k: usize| directions.get(k).copied().unwrap_or_default();
                let ([x, y], [next_x, next_y]) = (at(k), at(k + 1));
                let share = 1.0 / (directions.len() as f64 * step_s);
                [share * (x - next_x), share * (y - next_y), 0.0]
            }
        }
    }
}

impl MeanSpeed {
    /// The bounds that exist: the lower, then the upper one.
    pub fn bounds(&self, vehicle: usize) -> impl Iterator<Item = MeanSpeedBound> + use<> {
        let (penalty, measure) = (self.penalty, self.measure.clone());
        let bounds = [(self.lower_mps, false), (self.upper_mps, true)];
        bounds.into_iter().filter_map(move |(bound, is_upper)| {
            let speed_mps = bound?;
            Some(MeanSpeedBound { vehicle, measure: measure.clone(), speed_mps, is_upper, penalty })
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
        let mean = self.measure.evaluate(states);
        if self.is_upper { mean - self.speed_mps } else { self.speed_mps - mean }
    }

    fn expand(&self, states: &[State], row: &mut TrajectoryRow) {
        let sign = if self.is_upper { 1.0 } else { -1.0 };
        for (k, gradient) in row.gradients.iter_mut().enumerate() {
            *gradient = self.measure.gradient(k, states.len()).map(|slope| sign * slope);
        }
        row.bends.fill(0.0);
    }
}
