//! The quadratic programme of one step of the sequential method, in stage form, and the trait of its solvers.
//!
//! Unknowns are deviations from an iterate that obeys the dynamics: per vehicle `w_k = δu_k` and `d_{k+1} = δx_{k+1}`
//! with `d_0 = 0` and
//!
//! ```text
//! d_{k+1} = A_k d_k + B_k w_k                                       k = 0…N−1
//! minimise  Σ_k  g_k·d_{k+1} + ½ d_{k+1}ᵀ H_k d_{k+1}                tracking, x_{k+1}
//!              + ½ (d_k, w_k)ᵀ C_k (d_k, w_k)                        curvature of the dynamics
//!              + Σ_i r_{k,i} (Δū_{k,i} + w_{k,i} − w_{k−1,i})²       comfort and steering rate, w_{first−1} = 0
//!              + ½ μ Σ_i r_i w_{k,i}²                                damping, in the comfort's own scale
//!              + Σ_rows  linear·s + quadratic·s² + ½ pᵀ K p          soft rows, p the position they concern
//! such that  c + ∇c·p + s ≥ 0,  s ≥ 0                                rows
//!            lower ≤ w_k ≤ upper,  lower ≤ δv_{k+1} ≤ upper          boxes
//!            c₀ + Σ_k b_k·(p, v)_{k+1} + Σ_k β_k ‖p_{k+1}‖² ≤ s    rows over a whole trajectory, a few at most
//! ```
//!
//! A vehicle whose inputs are known until `first` has `w_k = 0` before. Where the vehicles are the futures of one, they have the
//! same `w_k` for `k` below `shared_steps`.

use crate::trajectory::penalty::Penalty;
use crate::vehicle::{DynamicsCurvature, Jacobian};

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
    /// Entry xy of the Hessian, which with its diagonal and `heading_cross` is positive semi-definite.
    pub cross: f64,
    /// Entries xθ and yθ of the Hessian.
    pub heading_cross: [f64; 2],
    /// What an exact Hessian adds over `(xx, xy, yy)` although it is not convex; zero for Gauss-Newton.
    pub curvature: [f64; 3],
}

/// Dynamics, costs and bounds of one vehicle at every stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VehicleStages {
    /// Index of the first stage whose input is free.
    pub first: usize,
    /// Jacobians `A_k, B_k` of the dynamics; `N` long.
    pub jacobians: Vec<Jacobian>,
    /// Gradients and Hessians `g_k, H_k` of the cost over `d_{k+1}`; `N` long.
    pub state_costs: Vec<StateCost>,
    /// Curvatures `C_k` of the dynamics over `(d_k, w_k)`; `N` long, all zero for a Gauss-Newton step.
    pub curvatures: Vec<DynamicsCurvature>,
    /// Weights `r` of the squared changes of `(a, δ)`.
    pub change_weights: [f64; 2],
    /// What is added to the weight of the change of `δ` at each stage, where it is too fast; `N` long, or empty.
    pub turn_weights: Vec<f64>,
    /// Changes of input `Δū_k` at the iterate, less the part of a change that is free where it is too fast; `N` long.
    pub changes: Vec<[f64; 2]>,
    /// Bounds of the input deviations `w_k = (δa, δδ)`; `N` long.
    pub input_boxes: Vec<[Interval; 2]>,
    /// Bounds of the speed deviations `δv_{k+1}`; `N` long.
    pub speed_boxes: Vec<Interval>,
}

/// One inequality row at one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Whether the row exists at this stage.
    pub active: bool,
    /// Value `c` of the row at the iterate.
    pub value: f64,
    /// `∇c` over `(x, y, θ)` of the vehicle; a row of a pair depends on the difference of positions, so its gradient
    /// over the other vehicle's `(x, y)` is the negative.
    pub gradient: [f64; 3],
    /// `K`: what the row adds to the Hessian of the Lagrangian over `(xx, xy, xθ, yy, yθ, θθ)`; zero for Gauss-Newton. Rows of
    /// pairs have none over θ.
    pub curvature: [f64; 6],
}

/// The same soft row at every stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowBlock {
    /// Index of the vehicle whose pose the row constrains.
    pub vehicle: usize,
    /// For a row of a pair, the index of the vehicle whose position is subtracted.
    pub other: Option<usize>,
    /// What a violation costs; `None` for a hard row.
    pub penalty: Option<Penalty>,
    /// One row a stage, on `d_{k+1}`; `N` long.
    pub rows: Vec<Row>,
}

/// A convex quadratic row over the whole trajectory of a vehicle: `value + Σ b_k·(x, y, v)_{k+1} + Σ β_k‖p_{k+1}‖² ≤ s`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrajectoryRow {
    /// Index of the vehicle whose trajectory is constrained.
    pub vehicle: usize,
    /// Value `c₀` of the row at the iterate.
    pub value: f64,
    /// `b_k` over `(x, y, v)` at stage `k`; `N` long.
    pub gradients: Vec<[f64; 3]>,
    /// `β ≥ 0` at stage `k`; `N` long (zero where the row says nothing).
    pub bends: Vec<f64>,
    /// What a violation costs.
    pub penalty: Penalty,
}

/// Which second derivatives a QP subproblem has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hessian {
    /// Those of the convex part of the cost only: every `curvature` is zero, and the problem is convex.
    #[default]
    GaussNewton,
    /// Those of the Lagrangian, or a share of what they add: the problem may not be convex.
    Lagrangian,
}

/// A quadratic programme in stage form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageQp {
    /// Number of stages `N`.
    pub horizon: usize,
    /// In how many first stages all vehicles have the same inputs.
    pub shared_steps: usize,
    /// The deciding vehicles.
    pub vehicles: Vec<VehicleStages>,
    /// Blocks of rows over single stages.
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
    /// Whether the curvatures of dynamics, rows and costs are in it.
    pub hessian: Hessian,
}

/// How far deviations are expected to go to either side, over all vehicles and stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Largest deviations `(δx, δy, δθ, δv)` of a state.
    pub state: [f64; 4],
    /// Largest deviations `(δa, δδ)` of an input.
    pub input: [f64; 2],
}

impl Reach {
    /// Returns the reach multiplied by `factor`.
    pub(crate) fn times(self, factor: f64) -> Reach {
        Reach { state: self.state.map(|reach| factor * reach), input: self.input.map(|reach| factor * reach) }
    }
}

impl StageQp {
    /// Whether rows couple two vehicles.
    pub(crate) fn has_pairs(&self) -> bool {
        self.blocks.iter().any(|block| block.other.is_some())
    }
}

impl VehicleStages {
    /// `μ r` of one input; not zero without a comfort weight.
    #[inline(always)]
    pub(crate) fn damping(&self, damping: f64, axis: usize) -> f64 {
        damping * self.change_weights[axis].max(1e-6)
    }

    /// The weight of the squared change of one input at a stage.
    #[inline(always)]
    pub(crate) fn change_weight(&self, k: usize, axis: usize) -> f64 {
        let turn = if axis == 1 { self.turn_weights.get(k).copied() } else { None };
        self.change_weights[axis] + turn.unwrap_or(0.0)
    }

    /// `Δū_k + w_k − w_{k−1}` of one input.
    pub(crate) fn change(&self, inputs: &[[f64; 2]], k: usize, axis: usize) -> f64 {
        let before = if k > self.first { inputs[k - 1][axis] } else { 0.0 };
        self.changes[k][axis] + inputs[k][axis] - before
    }
}

impl StateCost {
    /// The whole Hessian over the position: xx, xy, yy.
    pub(crate) fn position_hessian(&self) -> [f64; 3] {
        let ([xx, xy, yy], [x, y, ..]) = (self.curvature, self.hessian);
        [x + xx, self.cross + xy, y + yy]
    }

    /// The gradient where the state deviates by `d`.
    pub(crate) fn gradient_at(&self, d: &[f64; 4]) -> [f64; 4] {
        let ([xx, xy, yy], [xt, yt]) = (self.position_hessian(), self.heading_cross);
        [
            self.gradient[0] + xx * d[0] + xy * d[1] + xt * d[2],
            self.gradient[1] + xy * d[0] + yy * d[1] + yt * d[2],
            self.gradient[2] + self.hessian[2] * d[2] + (xt * d[0] + yt * d[1]),
            self.gradient[3] + self.hessian[3] * d[3],
        ]
    }
}

impl RowBlock {
    /// Whether a violation costs anything; a block that does not may be left out.
    pub(crate) fn costs_something(&self) -> bool {
        self.penalty.is_none_or(|penalty| penalty.linear > 0.0 || penalty.quadratic > 0.0)
    }
}

impl Row {
    /// `K d` over `(x, y, θ)` where the pose deviates by `d`.
    pub(crate) fn curvature_gradient(&self, [x, y, turn]: [f64; 3]) -> [f64; 3] {
        let [xx, xy, xt, yy, yt, tt] = self.curvature;
        [xx * x + xy * y + xt * turn, xy * x + yy * y + yt * turn, tt * turn + (xt * x + yt * y)]
    }
}

impl TrajectoryRow {
    /// The left side at given deviations of the vehicle's states.
    pub(crate) fn value_at<'a>(&self, states: impl Iterator<Item = &'a [f64; 4]>) -> f64 {
        let terms = states.zip(&self.gradients).zip(&self.bends);
        let terms = terms.map(|(([x, y, _, v], b), bend)| b[0] * x + b[1] * y + b[2] * v + bend * (x * x + y * y));
        self.value + terms.sum::<f64>()
    }

    /// `b_k + 2 β_k p`: the gradient over `(x, y, v)` at stage `k`, where the state deviates by `d`.
    pub(crate) fn slope_at(&self, k: usize, d: &[f64; 4]) -> [f64; 3] {
        let ([x, y, speed], bend) = (self.gradients[k], 2.0 * self.bends[k]);
        [x + bend * d[0], y + bend * d[1], speed]
    }
}
