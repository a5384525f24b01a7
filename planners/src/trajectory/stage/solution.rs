//! A solution of a stage problem, with its multipliers.

use super::qp::{Reach, StageQp};

/// A row with a multiplier above this is active.
pub(crate) const ACTIVE_MULTIPLIER: f64 = 1e-6;

/// The optimum of a [`StageQp`] with its multipliers (all non-negative).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageSolution {
    /// Input deviations `w_k`, by vehicle and stage.
    pub inputs: Vec<Vec<[f64; 2]>>,
    /// State deviations `d_{k+1}`, by vehicle and stage.
    pub states: Vec<Vec<[f64; 4]>>,
    /// Per vehicle and stage: multipliers of the lower and upper bounds of `δa`, `δδ` and `δv`, in that order.
    pub bound_multipliers: Vec<Vec<[[f64; 2]; 3]>>,
    /// Multipliers of the rows over single stages, by block and stage.
    pub row_multipliers: Vec<Vec<f64>>,
    /// Multipliers of the rows over whole trajectories.
    pub trajectory_multipliers: Vec<f64>,
    /// Number of iterations that the solver took.
    pub iterations: usize,
}

impl StageSolution {
    /// Leaves the multipliers a share of the way from `before` to where they are: a step cut short has not reached the rows
    /// that its end would touch.
    pub(crate) fn shorten(&mut self, before: &StageSolution, share: f64) {
        let mix = |now: &mut f64, was: &f64| *now = was + share * (*now - was);
        let bounds = self.bound_multipliers.iter_mut().flatten().flatten().flatten();
        bounds.zip(before.bound_multipliers.iter().flatten().flatten().flatten()).for_each(|(now, was)| mix(now, was));
        let rows = self.row_multipliers.iter_mut().flatten();
        rows.zip(before.row_multipliers.iter().flatten()).for_each(|(now, was)| mix(now, was));
        let trajectories = self.trajectory_multipliers.iter_mut();
        trajectories.zip(&before.trajectory_multipliers).for_each(|(now, was)| mix(now, was));
    }

    /// Whether there are multipliers for a problem of this shape.
    pub(crate) fn fits(&self, problem: &StageQp) -> bool {
        self.inputs.len() == problem.vehicles.len()
            && self.inputs.iter().all(|inputs| inputs.len() == problem.horizon)
            && self.row_multipliers.len() == problem.blocks.len()
            && self.trajectory_multipliers.len() == problem.trajectory_rows.len()
    }

    /// How far the deviations go.
    pub(crate) fn reach(&self) -> Reach {
        let mut reach = Reach::default();
        for state in self.states.iter().flatten() {
            reach.state = std::array::from_fn(|axis| reach.state[axis].max(state[axis].abs()));
        }
        for input in self.inputs.iter().flatten() {
            reach.input = std::array::from_fn(|axis| reach.input[axis].max(input[axis].abs()));
        }
        reach
    }

    /// Gives every field the shape of `problem`, keeping allocations.
    pub fn shape_like(&mut self, problem: &StageQp) {
        let (horizon, vehicles) = (problem.horizon, problem.vehicles.len());
        shape(&mut self.inputs, vehicles, horizon, [0.0; 2]);
        shape(&mut self.states, vehicles, horizon, [0.0; 4]);
        shape(&mut self.bound_multipliers, vehicles, horizon, [[0.0; 2]; 3]);
        shape(&mut self.row_multipliers, problem.blocks.len(), horizon, 0.0);
        self.trajectory_multipliers.resize(problem.trajectory_rows.len(), 0.0);
    }
}

fn shape<T: Copy>(field: &mut Vec<Vec<T>>, outer: usize, inner: usize, value: T) {
    field.resize_with(outer, Vec::new);
    for part in field {
        part.resize(inner, value);
    }
}
