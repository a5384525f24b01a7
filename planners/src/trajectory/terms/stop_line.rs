//! A line before which the front of a vehicle stays, at rest or moving: `s_line,t − front − s(p_t) ≥ 0`, softly, with an exact penalty. What
//! it costs to be beyond the line grows without bound, and its gradient points back everywhere.
//!
//! The gradient is `−∇s`, the Hessian `−∇²s`, both over the position; the body is taken along the road.

use std::sync::Arc;

use super::shape::{RowTerm, Subject};
use crate::Route;
use crate::trajectory::cost::Violation;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::penalty::Penalty;
use crate::vehicle::PoseExpansion;

/// A line that the front of a vehicle stays before.
#[derive(Clone, Debug, PartialEq)]
pub struct StopLine {
    /// Index of the vehicle that waits.
    pub vehicle: usize,
    /// Distance from the vehicle's mass centre to its front \[m\].
    pub front_m: f64,
    /// The route along which the line's place is measured.
    pub route: Arc<Route>,
    /// Arc lengths of the line on the route at `t = 1…N`; `N` long \[m\].
    pub lines_m: Vec<f64>,
    /// Cost of crossing the line.
    pub penalty: Penalty,
}

impl RowTerm for StopLine {
    fn subject(&self) -> Subject {
        Subject { vehicle: self.vehicle, other: None }
    }

    fn penalty(&self) -> Penalty {
        self.penalty
    }

    fn violation(&self) -> Option<Violation> {
        None
    }

    fn expand(&self, stage: usize, iterate: &Iterate, rows: &mut [PoseExpansion]) {
        let position = iterate.states[self.vehicle][stage + 1].position();
        let at =
            iterate.place(self.vehicle, stage).copied().unwrap_or_else(|| self.route.centre.expand(position, None));
        let [sx, sy] = at.along_gradient;
        let [xx, xy, yy] = at.along_hessian;
        rows[0] = PoseExpansion {
            value: self.lines_m[stage] - self.front_m - at.along_m,
            gradient: [-sx, -sy, 0.0],
            hessian: [-xx, -xy, 0.0, -yy, 0.0, 0.0],
        };
    }

    fn evaluate(&self, stage: usize, iterate: &Iterate, _room: &mut [PoseExpansion], values: &mut [f64]) {
        let position = iterate.states[self.vehicle][stage + 1].position();
        let along_m = iterate.place(self.vehicle, stage).map_or_else(|| self.route.along(position), |at| at.along_m);
        values[0] = self.lines_m[stage] - self.front_m - along_m;
    }
}
