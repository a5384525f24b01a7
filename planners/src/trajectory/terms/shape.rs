//! What a term may add to the cost of a trajectory.

use super::Comfort;
use crate::State;
use crate::trajectory::cost::Violation;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::penalty::Penalty;
use crate::trajectory::stage::{StateCost, TrajectoryRow};
use crate::vehicle::{OrientedEllipse, PoseExpansion};

/// Most rows that a term has at one stage.
pub(in crate::trajectory) const MAX_ROWS_PER_STAGE: usize = 4;

/// A term by the shape of what it adds.
pub(in crate::trajectory) enum Shape<'a> {
    StateCost(&'a dyn StateCostTerm),
    InputChange(&'a Comfort),
    Rows(&'a dyn RowTerm),
    Trajectory(&'a dyn TrajectoryTerm),
}

/// Whose state a row concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::trajectory) struct Subject {
    /// The vehicle.
    pub vehicle: usize,
    /// For a pair: the vehicle whose position is subtracted.
    pub other: Option<usize>,
}

/// A smooth cost `φ_t` of the state of one vehicle at `t = 1…N`. Stages count from 0: stage `k` is time `k + 1`.
pub(in crate::trajectory) trait StateCostTerm {
    /// Whose state.
    fn vehicle(&self) -> usize;

    /// Adds the value at a stage.
    fn add_value(&self, stage: usize, iterate: &Iterate, total: &mut f64);

    /// Adds gradient and Hessian at a stage: the positive semi-definite part of the Hessian to `cost`, the rest, over the
    /// position `(xx, xy, yy)`, to `concave`.
    fn add_expansion(&self, stage: usize, iterate: &Iterate, cost: &mut StateCost, concave: &mut [f64; 3]);
}

/// Soft rows `c_t + s ≥ 0` on the pose of a vehicle, or on the difference of two positions, the same at every stage.
pub(in crate::trajectory) trait RowTerm {
    /// Whose pose.
    fn subject(&self) -> Subject;

    /// How many rows at each stage, at most [`MAX_ROWS_PER_STAGE`].
    fn rows_per_stage(&self) -> usize {
        1
    }

    /// What a violation costs.
    fn penalty(&self) -> Penalty;

    /// What a violation is, if a planner wants to know of it.
    fn violation(&self) -> Option<Violation>;

    /// A row of a larger value is left out of QP subproblems; the merit still counts it.
    fn far_value(&self) -> f64 {
        f64::INFINITY
    }

    /// For a row around an ellipse, which a plan may pass on either side, the ellipse at a stage.
    fn ellipse(&self, _stage: usize) -> Option<&OrientedEllipse> {
        None
    }

    /// For a row around an ellipse, the position relative to its centre at a stage \[m\].
    fn relative_position(&self, _stage: usize, _iterate: &Iterate) -> Option<[f64; 2]> {
        None
    }

    /// `c_t` with its derivatives at a stage, for each of the [`RowTerm::rows_per_stage`] rows. For a pair the gradient
    /// over the other's position is the negative.
    fn expand(&self, stage: usize, iterate: &Iterate, rows: &mut [PoseExpansion]);

    /// Writes `c_t` at a stage for each row; where it is positive, any positive number will do. `room` is for derivatives.
    fn evaluate(&self, stage: usize, iterate: &Iterate, room: &mut [PoseExpansion], values: &mut [f64]) {
        self.expand(stage, iterate, room);
        values.iter_mut().zip(room).for_each(|(value, row)| *value = row.value);
    }
}

/// A convex quadratic soft row over all states of a vehicle, `c + s ≥ 0`.
pub(in crate::trajectory) trait TrajectoryTerm {
    /// Whose states.
    fn vehicle(&self) -> usize;

    /// What a violation costs.
    fn penalty(&self) -> Penalty;

    /// What a violation is, if a planner wants to know of it.
    fn violation(&self) -> Option<Violation>;

    /// `−c` at the states of `t = 0…N`: at most 0 where the row holds.
    fn excess(&self, states: &[State]) -> f64;

    /// Writes the gradient and the Hessian of [`TrajectoryTerm::excess`]; vectors of `row` keep their allocation.
    fn expand(&self, states: &[State], row: &mut TrajectoryRow);
}
