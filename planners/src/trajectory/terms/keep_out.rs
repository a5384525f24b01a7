//! An ellipse around a predicted motion that a vehicle keeps out of: `d² − 1 + s ≥ 0` at `t = 1…N` (eq. 6.8).
//!
//! With the exact penalty it is the safety constraint, with a hinge the human driver's discomfort `weight·max(0, 1 − d²)²`.

use super::shape::{RowTerm, Subject};
use crate::State;
use crate::trajectory::cost::Violation;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::penalty::Penalty;
use crate::vehicle::{OrientedEllipse, PoseExpansion};

/// Rows of this value and more (`d² ≥ 25`) are left out of QP subproblems.
pub(super) const FAR_VALUE: f64 = 24.0;

/// A moving ellipse that a vehicle must keep out of.
#[derive(Clone, Debug, PartialEq)]
pub struct KeepOut {
    /// Index of the vehicle that keeps out.
    pub vehicle: usize,
    /// Centres at `t = 1…N`; `N` long \[m\].
    pub centres: Vec<[f64; 2]>,
    /// The ellipse around each centre; `N` long.
    pub ellipses: Vec<OrientedEllipse>,
    /// Cost of entering the ellipse.
    pub penalty: Penalty,
}

impl KeepOut {
    /// How near a motion comes: the largest `1 − d²` over `t = 1…N`, negative outside. `states` begin at `t = 0`.
    pub fn intrusion(&self, states: &[State]) -> f64 {
        1.0 - self.nearest(states)
    }

    /// The least `d²` of a motion over `t = 1…N`; infinite where it has no states there. `states` begin at `t = 0`.
    pub fn nearest(&self, states: &[State]) -> f64 {
        let places = states.iter().skip(1).zip(&self.centres).zip(&self.ellipses);
        let distances = places.map(|((state, centre), ellipse)| ellipse.distance(state.position(), *centre).squared);
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// The row of an ellipse for a position and a centre.
pub(super) fn expand(ellipse: &OrientedEllipse, position: [f64; 2], centre: [f64; 2]) -> PoseExpansion {
    let distance = ellipse.distance(position, centre);
    let ([x, y], [xx, xy, yy]) = (distance.gradient, ellipse.hessian());
    PoseExpansion { value: distance.squared - 1.0, gradient: [x, y, 0.0], hessian: [xx, xy, 0.0, yy, 0.0, 0.0] }
}

/// Entering an ellipse is a violation of safety where the row is a constraint, and not a driver's discomfort.
pub(super) fn violation(penalty: &Penalty) -> Option<Violation> {
    penalty.is_exact().then_some(Violation::Safety)
}

impl RowTerm for KeepOut {
    fn subject(&self) -> Subject {
        Subject { vehicle: self.vehicle, other: None }
    }

    fn penalty(&self) -> Penalty {
        self.penalty
    }

    fn violation(&self) -> Option<Violation> {
        violation(&self.penalty)
    }

    fn far_value(&self) -> f64 {
        FAR_VALUE
    }

    fn ellipse(&self, stage: usize) -> Option<&OrientedEllipse> {
        self.ellipses.get(stage)
    }

    fn relative_position(&self, stage: usize, iterate: &Iterate) -> Option<[f64; 2]> {
        let ([x, y], [centre_x, centre_y]) = (iterate.states[self.vehicle][stage + 1].position(), self.centres[stage]);
        Some([x - centre_x, y - centre_y])
    }

    fn expand(&self, stage: usize, iterate: &Iterate, rows: &mut [PoseExpansion]) {
        let position = iterate.states[self.vehicle][stage + 1].position();
        rows[0] = expand(&self.ellipses[stage], position, self.centres[stage]);
    }

    fn evaluate(&self, stage: usize, iterate: &Iterate, _room: &mut [PoseExpansion], values: &mut [f64]) {
        let position = iterate.states[self.vehicle][stage + 1].position();
        values[0] = self.ellipses[stage].distance(position, self.centres[stage]).squared - 1.0;
    }
}
