//! What solving a problem gives.

/// An optimal point.
#[derive(Clone, Debug, PartialEq)]
pub struct StagedSolution {
    /// Inputs, stage by stage \[kW\].
    pub inputs: Vec<f64>,
    /// Temperatures at the ends of the stages \[°C\], stage by stage.
    pub states_c: Vec<f64>,
    /// How far each soft bound is exceeded \[K\], in the order of the stages.
    pub slack_k: Vec<f64>,
    /// The peak \[kW\]; 0 without one.
    pub peak_kw: f64,
    /// By how much the cost rises with the temperature of each node at the start \[1/K\]: the multipliers of the initial state.
    pub initial_value: Vec<f64>,
    /// The cost.
    pub objective: f64,
    /// By how much the cost can be above the least one, as the duality gap says.
    pub gap: f64,
    /// Number of iterations.
    pub iterations: u32,
}

/// Why there is no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StagedError {
    /// A number of the problem is not finite, or an upper limit is not above the lower one.
    #[error("the problem of stage {stage} holds a number that is not finite, or limits that leave no room")]
    Malformed {
        /// The stage, from zero.
        stage: usize,
    },
    /// The limit of iterations was reached, or rounding errors prevent progress.
    #[error("the plan was not found within {iterations} iterations: its cost is still uncertain by {gap:.3e}")]
    Unsolved {
        /// Number of iterations.
        iterations: u32,
        /// The duality gap that was reached.
        gap: f64,
    },
}
