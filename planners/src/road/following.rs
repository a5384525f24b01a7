//! Inputs that follow a road without an optimiser.

use super::centre_line::FrenetPoint;
use crate::vehicle::slip_on_curve_rad;
use crate::vehicle::{State, SteeringGeometry};

impl FrenetPoint {
    /// The steering angle with which a vehicle that is here comes to a lateral position \[rad\]. In a curve it also turns at the
    /// rate of the road, and heads inward by the slip angle.
    pub(crate) fn steer(&self, geometry: &SteeringGeometry, state: &State, lateral_m: f64) -> f64 {
        let slip_rad = slip_on_curve_rad(geometry.rear_axle_m, self.curvature_1pm);
        let heading_error_rad = state.heading_rad - self.heading_rad + slip_rad;
        geometry.correct(self.across_m - lateral_m, heading_error_rad, state.speed_mps, self.curvature_1pm)
    }
}
