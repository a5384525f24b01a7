//! Costs and constraints of another crate: the shapes that they may have, as public traits of one vehicle's motion.
//!
//! ```
//! use interplay_planners::State;
//! use interplay_planners::trajectory::{StateCost, Term};
//! use interplay_planners::trajectory::terms::{CostOfState, ForeignTerm};
//!
//! /// `weight · v²`: what a heavy vehicle pays for its speed.
//! #[derive(Debug)]
//! struct EnergyCost {
//!     weight: f64,
//! }
//!
//! impl CostOfState for EnergyCost {
//!     fn value(&self, _: usize, state: &State) -> f64 {
//!         self.weight * state.speed_mps * state.speed_mps
//!     }
//!
//!     fn expand(&self, _: usize, state: &State) -> StateCost {
//!         let gradient = [0.0, 0.0, 0.0, 2.0 * self.weight * state.speed_mps];
//!         StateCost { gradient, hessian: [0.0, 0.0, 0.0, 2.0 * self.weight], ..StateCost::default() }
//!     }
//! }
//!
//! let term = Term::Foreign(ForeignTerm::cost(0, EnergyCost { weight: 0.1 }));
//! ```
//!
//! [`check_derivatives`](crate::trajectory::check_derivatives) compares what a term states with differences of its values.

use std::fmt;
use std::sync::Arc;

use super::shape::{RowTerm, Shape, StateCostTerm, Subject, TrajectoryTerm};
use crate::State;
use crate::trajectory::cost::Violation;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::penalty::Penalty;
use crate::trajectory::stage::{StateCost, TrajectoryRow};
use crate::vehicle::PoseExpansion;

/// A smooth cost `φ_t(x_t)` of the state of one vehicle, summed over `t = 1…N`.
pub trait CostOfState: fmt::Debug + Send + Sync {
    /// The value at time `t`.
    fn value(&self, t: usize, state: &State) -> f64;

    /// Gradient and Hessian at time `t`. The part of the Hessian over the position that is not convex goes into `curvature`; the
    /// rest must be positive semi-definite.
    fn expand(&self, t: usize, state: &State) -> StateCost;
}

/// A soft row `c_t(x, y, θ) + s ≥ 0` on the pose of one vehicle at each of `t = 1…N`.
pub trait RowOnPose: fmt::Debug + Send + Sync {
    /// What a violation `s` costs.
    fn penalty(&self) -> Penalty;

    /// `c_t` with its derivatives at time `t`.
    fn expand(&self, t: usize, state: &State) -> PoseExpansion;
}

/// A convex quadratic soft row over the whole motion of one vehicle, `e(x_0…x_N) ≤ s`.
pub trait RowOnTrajectory: fmt::Debug + Send + Sync {
    /// What a violation `s` costs.
    fn penalty(&self) -> Penalty;

    /// `e` at the states of `t = 0…N`: at most 0 where the row holds.
    fn excess(&self, states: &[State]) -> f64;

    /// Writes the expansion of `e` into `row`, whose lists have an entry for each of `t = 1…N`: with deviations `d_t`,
    /// `e(x + d) = e(x) + Σ gradients_t·(d_x, d_y, d_v) + Σ bends_t (d_x² + d_y²)`, where no bend is negative.
    fn expand(&self, states: &[State], row: &mut TrajectoryRow);
}

/// A cost or soft constraint of another crate, on one vehicle of a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignTerm(pub(super) Form);

/// A foreign term by its shape.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Form {
    Cost(OfVehicle<dyn CostOfState>),
    Row(OfVehicle<dyn RowOnPose>),
    Trajectory(OfVehicle<dyn RowOnTrajectory>),
}

/// A term with the number of its vehicle.
#[derive(Debug)]
pub(super) struct OfVehicle<T: ?Sized> {
    pub vehicle: usize,
    own: Arc<T>,
}

impl ForeignTerm {
    /// A cost of the states of a vehicle of the problem.
    pub fn cost(vehicle: usize, cost: impl CostOfState + 'static) -> ForeignTerm {
        ForeignTerm(Form::Cost(OfVehicle { vehicle, own: Arc::new(cost) }))
    }

    /// A soft row on the pose of a vehicle of the problem, the same at every stage.
    pub fn row(vehicle: usize, row: impl RowOnPose + 'static) -> ForeignTerm {
        ForeignTerm(Form::Row(OfVehicle { vehicle, own: Arc::new(row) }))
    }

    /// A soft row over the whole motion of a vehicle of the problem.
    pub fn trajectory_row(vehicle: usize, row: impl RowOnTrajectory + 'static) -> ForeignTerm {
        ForeignTerm(Form::Trajectory(OfVehicle { vehicle, own: Arc::new(row) }))
    }

    /// The number of its vehicle.
    pub(super) fn vehicle_mut(&mut self) -> &mut usize {
        match &mut self.0 {
            Form::Cost(term) => &mut term.vehicle,
            Form::Row(term) => &mut term.vehicle,
            Form::Trajectory(term) => &mut term.vehicle,
        }
    }

    pub(super) fn shape(&self) -> Shape<'_> {
        match &self.0 {
            Form::Cost(term) => Shape::StateCost(term),
            Form::Row(term) => Shape::Rows(term),
            Form::Trajectory(term) => Shape::Trajectory(term),
        }
    }
}

impl<T: ?Sized> Clone for OfVehicle<T> {
    fn clone(&self) -> Self {
        OfVehicle { vehicle: self.vehicle, own: Arc::clone(&self.own) }
    }
}

/// Two foreign terms are the same if one is a copy of the other.
impl<T: ?Sized> PartialEq for OfVehicle<T> {
    fn eq(&self, other: &Self) -> bool {
        self.vehicle == other.vehicle && std::ptr::addr_eq(Arc::as_ptr(&self.own), Arc::as_ptr(&other.own))
    }
}

impl StateCostTerm for OfVehicle<dyn CostOfState> {
    fn vehicle(&self) -> usize {
        self.vehicle
    }

    fn add_value(&self, stage: usize, iterate: &Iterate, total: &mut f64) {
        *total += self.own.value(stage + 1, &iterate.states[self.vehicle][stage + 1]);
    }

    fn add_expansion(&self, stage: usize, iterate: &Iterate, cost: &mut StateCost, concave: &mut [f64; 3]) {
        let own = self.own.expand(stage + 1, &iterate.states[self.vehicle][stage + 1]);
        let add = |sums: &mut [f64], more: &[f64]| sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        add(&mut cost.gradient, &own.gradient);
        add(&mut cost.hessian, &own.hessian);
        add(&mut cost.heading_cross, &own.heading_cross);
        add(concave, &own.curvature);
        cost.cross += own.cross;
    }
}

impl RowTerm for OfVehicle<dyn RowOnPose> {
    fn subject(&self) -> Subject {
        Subject { vehicle: self.vehicle, other: None }
    }

    fn penalty(&self) -> Penalty {
        self.own.penalty()
    }

    fn violation(&self) -> Option<Violation> {
        None
    }

    fn expand(&self, stage: usize, iterate: &Iterate, rows: &mut [PoseExpansion]) {
        rows[0] = self.own.expand(stage + 1, &iterate.states[self.vehicle][stage + 1]);
    }
}

impl TrajectoryTerm for OfVehicle<dyn RowOnTrajectory> {
    fn vehicle(&self) -> usize {
        self.vehicle
    }

    fn penalty(&self) -> Penalty {
        self.own.penalty()
    }

    fn violation(&self) -> Option<Violation> {
        None
    }

    fn excess(&self, states: &[State]) -> f64 {
        self.own.excess(states)
    }

    fn expand(&self, states: &[State], row: &mut TrajectoryRow) {
        self.own.expand(states, row);
    }
}
