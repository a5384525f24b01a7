//! What the plan of the step before leaves to a descent, as text.

use interplay_planners::trajectory::{Reach, StageSolution, WarmStart};
use serde::{Deserialize, Serialize};

/// A [`WarmStart`], rounded to six digits: multipliers as pairs of index and value, those that hardly differ from zero left out.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct WarmStartRecord {
    /// Per vehicle, of the bounds.
    pub bounds: Vec<Vec<(usize, f64)>>,
    /// Per block, of the rows.
    pub rows: Vec<Vec<(usize, f64)>>,
    /// Of the rows over whole trajectories.
    pub trajectories: Vec<f64>,
    /// How far the descent's first step was expected to go.
    pub reach: Option<[f64; 6]>,
}

impl WarmStartRecord {
    /// The part of a warm start that is recorded; `None` if it is empty.
    pub fn new(of: &WarmStart) -> Option<Self> {
        let sparse = |values: &[f64]| {
            let kept = values.iter().enumerate().filter(|(_, value)| **value > 1e-6);
            kept.map(|(index, value)| (index, rounded(*value))).collect()
        };
        let bounds = of.multipliers.bound_multipliers.iter();
        (!of.multipliers.inputs.is_empty()).then(|| WarmStartRecord {
            bounds: bounds.map(|bounds| sparse(bounds.as_flattened().as_flattened())).collect(),
            rows: of.multipliers.row_multipliers.iter().map(|rows| sparse(rows)).collect(),
            trajectories: of.multipliers.trajectory_multipliers.iter().copied().map(rounded).collect(),
            reach: of.reach.map(|Reach { state: [x, y, t, v], input: [a, d] }| [x, y, t, v, a, d].map(rounded)),
        })
    }

    /// The warm start for a problem of `horizon` steps.
    pub fn warm_start(&self, horizon: usize) -> WarmStart {
        let fill = |values: &mut [f64], sparse: &[(usize, f64)]| {
            for (index, value) in sparse {
                values[*index] = *value;
            }
        };
        let vehicles = self.bounds.len();
        let mut multipliers = StageSolution {
            inputs: vec![vec![[0.0; 2]; horizon]; vehicles],
            states: vec![vec![[0.0; 4]; horizon]; vehicles],
            bound_multipliers: vec![vec![[[0.0; 2]; 3]; horizon]; vehicles],
            row_multipliers: vec![vec![0.0; horizon]; self.rows.len()],
            trajectory_multipliers: self.trajectories.clone(),
            iterations: 0,
        };
        for (values, sparse) in multipliers.bound_multipliers.iter_mut().zip(&self.bounds) {
            fill(values.as_flattened_mut().as_flattened_mut(), sparse);
        }
        for (values, sparse) in multipliers.row_multipliers.iter_mut().zip(&self.rows) {
            fill(values, sparse);
        }
        let reach = self.reach.map(|[x, y, t, v, a, d]| Reach { state: [x, y, t, v], input: [a, d] });
        WarmStart { multipliers, reach }
    }
}

fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
