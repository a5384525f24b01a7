//! Rows over a whole trajectory: each changes the Hessian by rank one (see the parent module).

use super::rows::Point;
use crate::trajectory::stage::qp::TrajectoryRow;

/// One such row at the current point.
#[derive(Clone, Debug, Default)]
pub(super) struct ExpandedTrajectoryRow {
    vehicle: usize,
    /// Its gradient `v` over `(x, y, v)` after every stage.
    slopes: Vec<[f64; 3]>,
    /// `H⁻¹ v`, `H` with the rows before this one.
    pub response: Point,
}

impl ExpandedTrajectoryRow {
    /// Takes over a row's shape.
    pub fn shape_like(&mut self, row: &TrajectoryRow) {
        self.vehicle = row.vehicle;
        self.slopes.clear();
        self.slopes.resize(row.gradients.len(), [0.0; 3]);
    }

    /// Refreshes the gradient at a point, and returns how far the row is inside.
    pub fn refresh(&mut self, row: &TrajectoryRow, point: &Point, vehicles: usize) -> f64 {
        let states = || point.states.iter().skip(row.vehicle).step_by(vehicles);
        for (k, (slope, d)) in self.slopes.iter_mut().zip(states()).enumerate() {
            *slope = row.slope_at(k, d);
        }
        -row.value_at(states())
    }

    /// `v·z`.
    pub fn dot(&self, point: &Point, vehicles: usize) -> f64 {
        let states = point.states.iter().skip(self.vehicle).step_by(vehicles);
        self.slopes.iter().zip(states).map(|(v, d)| v[0] * d[0] + v[1] * d[1] + v[2] * d[3]).sum()
    }

    /// Adds `share · v` to a gradient.
    pub fn add_gradient(&self, share: f64, gradient: &mut Point, vehicles: usize) {
        let states = gradient.states.iter_mut().skip(self.vehicle).step_by(vehicles);
        for (v, d) in self.slopes.iter().zip(states) {
            d[0] += share * v[0];
            d[1] += share * v[1];
            d[3] += share * v[2];
        }
    }

    /// Sherman and Morrison: from the step without this row's `ω v vᵀ` to the one with it.
    pub fn correct(&self, weight: f64, step: &mut Point, vehicles: usize) {
        let share = weight * self.dot(step, vehicles) / (1.0 + weight * self.dot(&self.response, vehicles));
        step.add(-share, &self.response);
    }
}
