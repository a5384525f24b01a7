//! The quadratic programme of one step of the sequential method, in stage form, and the trait of its solvers.
//!
//! Unknowns are deviations from an iterate that obeys the dynamics: per vehicle `w_k = δu_k` and `d_{k+1} = δx_{k+1}`
//! with `d_0 = 0` and
//!
//! ```text
//! d_{k+1} = A_k d_k + B_k w_k                                       k = 0…N−1
//! minimise  Σ_k  g_k·d_{k+1} + ½ d_{k+1}ᵀ H_k d_{k+1}                tracking, x_{k+1}
//!              + ½ (d_k, w_k)ᵀ C_k (d_k, w_k)                        curvature of the dynamics
//!              + Σ_i r_i (Δū_{k,i} + w_{k,i} − w_{k−1,i})²           comfort, w_{first−1} = 0
//!              + ½ μ Σ_i r_i w_{k,i}²                                damping, in the comfort's own scale
//!              + Σ_rows  linear·s + quadratic·s² + ½ pᵀ K p          soft rows, p the position they speak of
//! such that  c + ∇c·p + s ≥ 0,  s ≥ 0                                rows
//!            lower ≤ w_k ≤ upper,  lower ≤ δv_{k+1} ≤ upper          boxes
//!            c₀ + Σ_k b_k·(p, v)_{k+1} + Σ_k β_k ‖p_{k+1}‖² ≤ s    rows over a whole trajectory, a few at most
//! ```
//!
//! A vehicle whose inputs are known until `first` has `w_k = 0` before.

use thiserror::Error;

use super::Penalty;
use crate::dynamics::{Curvature, Jacobian};

/// Lower and upper bound of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
}

/// Gradient and Hessian of the cost of a state at one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StateCost {
    /// Gradient over `(x, y, θ, v)`.
    pub gradient: [f64; 4],
    /// Diagonal of the Hessian over `(x, y, θ, v)`.
    pub hessian: [f64; 4],
    /// Its entry xy. With the diagonal it is positive semi-definite.
    pub cross: f64,
    /// What the Hessian lacks of the exact one over `(xx, xy, yy)` because it is not convex; zero for Gauss-Newton.
    pub curvature: [f64; 3],
}

/// One vehicle's stages.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VehicleStages {
    /// First stage whose input is free.
    pub first: usize,
    /// `A_k, B_k`; `N` long.
    pub jacobians: Vec<Jacobian>,
    /// `g_k, H_k` on `d_{k+1}`; `N` long.
    pub state_costs: Vec<StateCost>,
    /// `C_k` on `(d_k, w_k)`; `N` long, all zero for a Gauss-Newton step.
    pub curvatures: Vec<Curvature>,
    /// `r` on `(a, δ)`.
    pub change_weights: [f64; 2],
    /// `Δū_k`; `N` long.
    pub changes: Vec<[f64; 2]>,
    /// Box on `w_k = (δa, δδ)`; `N` long.
    pub input_boxes: Vec<[Interval; 2]>,
    /// Box on `δv_{k+1}`; `N` long.
    pub speed_boxes: Vec<Interval>,
}

/// One row at one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Whether the row exists at this stage.
    pub active: bool,
    /// `c` at the iterate.
    pub value: f64,
    /// `∇c` over `(x, y, θ)` of the vehicle; a row of a pair depends on the difference of positions, so its gradient
    /// over the other vehicle's `(x, y)` is the negative.
    pub gradient: [f64; 3],
    /// `K`: what the row adds to the Hessian of the Lagrangian over `(xx, xy, yy, θθ)`; zero for Gauss-Newton.
    pub curvature: [f64; 4],
}

/// The same soft row at every stage.
#[derive(Clone, Debug, PartialEq)]
pub struct RowBlock {
    /// Whose position the row speaks of.
    pub vehicle: usize,
    /// For a pair: the vehicle whose position is subtracted.
    pub other: Option<usize>,
    /// What a violation costs; `None` for a hard row.
    pub penalty: Option<Penalty>,
    /// One row a stage, on `d_{k+1}`; `N` long.
    pub rows: Vec<Row>,
}

/// A convex quadratic row over the whole trajectory of a vehicle: `value + Σ b_k·(x, y, v)_{k+1} + Σ β_k‖p_{k+1}‖² ≤ s`.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryRow {
    /// Whose trajectory.
    pub vehicle: usize,
    /// `c₀`.
    pub value: f64,
    /// `b_k` over `(x, y, v)` at stage `k`; `N` long.
    pub gradients: Vec<[f64; 3]>,
    /// `β ≥ 0` at stage `k`; `N` long (zero where the row says nothing).
    pub bends: Vec<f64>,
    /// What a violation costs.
    pub penalty: Penalty,
}

/// A quadratic programme in stage form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageQp {
    /// Number of stages `N`.
    pub horizon: usize,
    /// The vehicles.
    pub vehicles: Vec<VehicleStages>,
    /// The soft rows.
    pub blocks: Vec<RowBlock>,
    /// The rows over whole trajectories.
    pub trajectory_rows: Vec<TrajectoryRow>,
    /// Mean complementarity and largest primal residual of a solution that will do.
    pub tolerance: f64,
    /// `μ ≥ 0`: keeps the step short, in units of the comfort weights.
    pub damping: f64,
    /// How far the solution is expected to be, if anything is known about that. A solver may begin without the rows that are
    /// farther, and must look at them in the end.
    pub reach: Option<Reach>,
}

/// How far deviations are expected to go to either side, over all vehicles and stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Of `(δx, δy, δθ, δv)`.
    pub state: [f64; 4],
    /// Of `(δa, δδ)`.
    pub input: [f64; 2],
}

impl StageQp {
    /// Whether curvature of dynamics or rows was added, so that the problem may not be convex.
    pub fn is_curved(&self) -> bool {
        let rows = self.blocks.iter().flat_map(|block| &block.rows);
        let costs = self.vehicles.iter().flat_map(|stages| &stages.state_costs);
        self.vehicles.iter().any(|stages| stages.curvatures.iter().any(|c| *c != Curvature::default()))
            || rows.into_iter().any(|row| row.curvature != [0.0; 4])
            || costs.into_iter().any(|cost| cost.curvature != [0.0; 3])
    }
}

/// The optimum of a [`StageQp`] with its multipliers (all non-negative).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageSolution {
    /// Per vehicle and stage, `w_k`.
    pub inputs: Vec<Vec<[f64; 2]>>,
    /// Per vehicle and stage, `d_{k+1}`.
    pub states: Vec<Vec<[f64; 4]>>,
    /// Per vehicle and stage: multipliers of the lower and upper bounds of `δa`, `δδ` and `δv`, in that order.
    pub bound_multipliers: Vec<Vec<[[f64; 2]; 3]>>,
    /// Per block and stage.
    pub row_multipliers: Vec<Vec<f64>>,
    /// Of the rows over whole trajectories.
    pub trajectory_multipliers: Vec<f64>,
    /// Iterations that the solver took.
    pub iterations: usize,
}

/// Why a stage problem has no solution to offer.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StageError {
    /// No point satisfies the boxes and hard rows.
    #[error("the boxes and hard rows contradict each other ({iterations} iterations)")]
    Infeasible {
        /// Iterations taken.
        iterations: usize,
    },
    /// The Hessian is not positive definite on the dynamics.
    #[error("the problem is not convex at stage {stage}")]
    NotConvex {
        /// Where the factorisation failed.
        stage: usize,
    },
    /// The iteration limit or a numerical breakdown.
    #[error("not solved after {iterations} iterations: {status}")]
    Unsolved {
        /// What the solver said.
        status: String,
        /// Iterations taken.
        iterations: usize,
    },
}

/// A solver of stage problems. It may keep memory between calls, but the answer must not depend on it beyond the stated
/// tolerance.
pub trait StageSolver {
    /// Whether the solver accepts an indefinite Hessian (and refuses it with [`StageError::NotConvex`] where it
    /// matters). Others are given Gauss-Newton problems only.
    fn accepts_curvature(&self) -> bool;

    /// Solves `problem`, writing the optimum and its multipliers to `solution`. With `warm`, the multipliers that
    /// `solution` holds belong to a neighbouring problem of the same shape and may serve as a start.
    ///
    /// # Errors
    /// [`StageError`]; `solution` is then meaningless.
    fn solve(&mut self, problem: &StageQp, solution: &mut StageSolution, warm: bool) -> Result<(), StageError>;
}

impl StageSolution {
    /// Leaves the multipliers a share of the way from `before` to where they are: a step cut short has not reached the rows
    /// that its end would touch.
    pub(super) fn retreat(&mut self, before: &StageSolution, share: f64) {
        let mix = |now: &mut f64, was: &f64| *now = was + share * (*now - was);
        let bounds = self.bound_multipliers.iter_mut().flatten().flatten().flatten();
        bounds.zip(before.bound_multipliers.iter().flatten().flatten().flatten()).for_each(|(now, was)| mix(now, was));
        let rows = self.row_multipliers.iter_mut().flatten();
        rows.zip(before.row_multipliers.iter().flatten()).for_each(|(now, was)| mix(now, was));
        let trajectories = self.trajectory_multipliers.iter_mut();
        trajectories.zip(&before.trajectory_multipliers).for_each(|(now, was)| mix(now, was));
    }
}

impl Reach {
    /// So many times as far.
    pub(super) fn times(self, factor: f64) -> Reach {
        Reach { state: self.state.map(|reach| factor * reach), input: self.input.map(|reach| factor * reach) }
    }
}

impl VehicleStages {
    /// `μ r` of one input; not zero without a comfort weight.
    #[inline(always)]
    pub(super) fn damping(&self, damping: f64, axis: usize) -> f64 {
        damping * self.change_weights[axis].max(1e-6)
    }

    /// `Δū_k + w_k − w_{k−1}` of one input.
    pub(super) fn change(&self, inputs: &[[f64; 2]], k: usize, axis: usize) -> f64 {
        let before = if k > self.first { inputs[k - 1][axis] } else { 0.0 };
        self.changes[k][axis] + inputs[k][axis] - before
    }
}

impl StateCost {
    /// The whole Hessian over the position: xx, xy, yy.
    pub(super) fn position_hessian(&self) -> [f64; 3] {
        let ([xx, xy, yy], [x, y, ..]) = (self.curvature, self.hessian);
        [x + xx, self.cross + xy, y + yy]
    }

    /// The gradient where the state deviates by `d`.
    pub(super) fn gradient_at(&self, d: &[f64; 4]) -> [f64; 4] {
        let [xx, xy, yy] = self.position_hessian();
        [
            self.gradient[0] + xx * d[0] + xy * d[1],
            self.gradient[1] + xy * d[0] + yy * d[1],
            self.gradient[2] + self.hessian[2] * d[2],
            self.gradient[3] + self.hessian[3] * d[3],
        ]
    }
}

impl RowBlock {
    /// Whether a violation costs anything; a block that does not may be left out.
    pub(super) fn costs_something(&self) -> bool {
        self.penalty.is_none_or(|penalty| penalty.linear > 0.0 || penalty.quadratic > 0.0)
    }
}

impl TrajectoryRow {
    /// The left side at given deviations of the vehicle's states.
    pub(super) fn value_at<'a>(&self, states: impl Iterator<Item = &'a [f64; 4]>) -> f64 {
        let terms = states.zip(&self.gradients).zip(&self.bends);
        let terms = terms.map(|(([x, y, _, v], b), bend)| b[0] * x + b[1] * y + b[2] * v + bend * (x * x + y * y));
        self.value + terms.sum::<f64>()
    }

    /// `b_k + 2 β_k p`: the gradient over `(x, y, v)` at stage `k`, where the state deviates by `d`.
    pub(super) fn slope_at(&self, k: usize, d: &[f64; 4]) -> [f64; 3] {
        let ([x, y, speed], bend) = (self.gradients[k], 2.0 * self.bends[k]);
        [x + bend * d[0], y + bend * d[1], speed]
    }
}

impl StageSolution {
    /// Whether there are multipliers for a problem of this shape.
    pub(super) fn fits(&self, problem: &StageQp) -> bool {
        self.inputs.len() == problem.vehicles.len()
            && self.inputs.iter().all(|inputs| inputs.len() == problem.horizon)
            && self.row_multipliers.len() == problem.blocks.len()
            && self.trajectory_multipliers.len() == problem.trajectory_rows.len()
    }

    /// How far the deviations go.
    pub(super) fn reach(&self) -> Reach {
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
