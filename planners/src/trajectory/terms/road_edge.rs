//! Road edges: the four corners stay on the road (eq. 6.7 in the road's frame), softly, with an exact penalty.
//!
//! The rows are [`Route::clearances`], which state the mathematics.

use std::sync::Arc;

use super::shape::{RowTerm, Subject};
use crate::road::centre_line::FrenetPoint;
use crate::trajectory::cost::Violation;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::penalty::Penalty;
use crate::vehicle::PoseExpansion;
use crate::{Body, Corridor, Route};

/// On a curved road, corners that are farther inside their edge than this many widths of the body have approximate derivatives in
/// QP subproblems. The rows of an optimum that hold it back are zero there, so they are exact.
const EXACT_WIDTHS: f64 = 1.0;

/// The constraint that the four corners of a vehicle stay on its road (eq. 6.7).
#[derive(Clone, Debug, PartialEq)]
pub struct RoadEdge {
    /// Index of the vehicle whose corners stay on the road.
    pub vehicle: usize,
    /// Body of that vehicle.
    pub body: Body,
    /// The road; if it is curved, that of the participant's [`RouteStart`](crate::trajectory::RouteStart).
    pub route: Arc<Route>,
    /// Cost of a corner beyond the edge.
    pub penalty: Penalty,
}

impl RoadEdge {
    /// The constraint of a straight road.
    pub fn straight(vehicle: usize, body: Body, corridor: Corridor, penalty: Penalty) -> RoadEdge {
        RoadEdge { vehicle, body, route: corridor.into(), penalty }
    }
}

impl RoadEdge {
    /// Where the vehicle is beside a curved road. On a straight one the rows do not ask.
    fn place(&self, stage: usize, iterate: &Iterate) -> FrenetPoint {
        if self.route.straight().is_some() {
            FrenetPoint::default()
        } else {
            iterate.frenet[self.vehicle][stage].point()
        }
    }
}

impl RowTerm for RoadEdge {
    fn subject(&self) -> Subject {
        Subject { vehicle: self.vehicle, other: None }
    }

    fn rows_per_stage(&self) -> usize {
        4
    }

    fn penalty(&self) -> Penalty {
        self.penalty
    }

    fn violation(&self) -> Option<Violation> {
        Some(Violation::RoadEdge)
    }

    fn expand(&self, stage: usize, iterate: &Iterate, rows: &mut [PoseExpansion]) {
        let state = &iterate.states[self.vehicle][stage + 1];
        let exact_m = EXACT_WIDTHS * self.body.width_m;
        self.route.write_clearances(exact_m, &self.body, state, &self.place(stage, iterate), rows);
    }

    fn evaluate(&self, stage: usize, iterate: &Iterate, _room: &mut [PoseExpansion], values: &mut [f64]) {
        let state = &iterate.states[self.vehicle][stage + 1];
        values.copy_from_slice(&self.route.clearance_bounds(&self.body, state, &self.place(stage, iterate)));
    }
}
