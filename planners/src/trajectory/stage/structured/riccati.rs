//! Unconstrained stage problems over the dynamics of `M` bicycles: a factorisation and a solve.
//!
//! The state of a vehicle at stage `k` is `(d_k, w_{k−1})` ∈ ℝ⁶ because the comfort cost couples inputs of neighbouring
//! stages. With the cost-to-go `½ zᵀP z + pᵀz`, `P` made of 6×6 blocks, one stage back is
//!
//! ```text
//! F_ww = BᵀPB + 2R + …,   F_wz = BᵀPA − 2R (previous input),   F_zz = AᵀPA + 2R (previous input)
//! F_ww = L Lᵀ,            V = L⁻¹ F_wz,                          P ← F_zz − Vᵀ V
//! ```
//!
//! and with a gradient, `f` being to `F` what `p` is to `P`,
//!
//! ```text
//! y = L⁻¹ f_w,            p ← f_z − Vᵀ y,                        w = −L⁻ᵀ (V z + y)
//! ```
//!
//! Where the vehicles are the futures of one and share their inputs, the rows and columns of `F_ww`, `F_wz` and `f_w` are summed over
//! them: with `w = E w̄`, `E` of unit matrices, `F_ww` becomes `Eᵀ F_ww E`.
//!
//! The gains `−L⁻ᵀ V` are never formed. Vehicles meet only where rows of a pair fill the off-diagonal blocks of `P`, of which
//! the lower ones are kept.

use super::cholesky::Cholesky;
use super::rows::Point;
use crate::trajectory::stage::qp::StageQp;
use crate::trajectory::stage::solver::StageError;
use crate::vehicle::Jacobian;

/// Number of states of a vehicle with its previous input.
const STATE_SIZE: usize = 6;

/// Second derivatives of one vehicle at one stage: cost, barrier and curvature.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VehicleHessian {
    /// Over `(x, y, θ)` of `d_{k+1}`: xx, xy, xθ, yy, yθ, θθ.
    pub pose: [f64; 6],
    /// Over the speed of `d_{k+1}`.
    pub speed: f64,
    /// Over `w_k`, diagonal, without the comfort cost.
    pub input: [f64; 2],
}

/// Hessian over the difference `p_i − p_j` of two vehicles' positions at one stage: xx, xy, yy.
pub(super) type PairHessian = [f64; 3];

/// Returns the number of pairs among `vehicles` vehicles.
pub(super) const fn pairs_among(vehicles: usize) -> usize {
    vehicles * vehicles.saturating_sub(1) / 2
}

/// Returns all pairs among `vehicles` vehicles, the larger index first, in the order in which their Hessians are kept.
pub(super) fn pairs(vehicles: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..vehicles).flat_map(|i| (0..i).map(move |j| [i, j]))
}

/// Returns the index of a pair's Hessian among those of its stage.
pub(super) fn pair_index(a: usize, b: usize) -> usize {
    let (i, j) = (a.max(b), a.min(b));
    pairs_among(i) + j
}

/// Factors of a stage problem of `W/2` vehicles; `Z = 3 W`.
#[derive(Clone, Debug)]
pub(super) struct Riccati<const W: usize, const Z: usize> {
    /// `L`.
    factors: Vec<Cholesky<W>>,
    /// `V`.
    couplings: Vec<[[f64; Z]; W]>,
    /// `y`.
    feeds: Vec<[f64; W]>,
}

impl<const W: usize, const Z: usize> Default for Riccati<W, Z> {
    fn default() -> Self {
        Riccati { factors: Vec::new(), couplings: Vec::new(), feeds: Vec::new() }
    }
}

/// `Xᵀ A` for one row of four: the bicycle's `A` has five entries beside its diagonal.
#[inline(always)]
fn times_a(row: &[f64; 4], j: &Jacobian) -> [f64; 4] {
    [
        row[0],
        row[1],
        row[2] + j.x_heading * row[0] + j.y_heading * row[1],
        row[3] + j.x_speed * row[0] + j.y_speed * row[1] + j.heading_speed * row[2],
    ]
}

/// `Xᵀ B` for one row of four.
#[inline(always)]
fn times_b(row: &[f64; 4], j: &Jacobian) -> [f64; 2] {
    [j.speed_acceleration * row[3], j.x_steering * row[0] + j.y_steering * row[1] + j.heading_steering * row[2]]
}

/// `½ wᵀF_ww w + wᵀF_wz z + ½ zᵀF_zz z`: what a stage and all later ones cost, over its inputs and the states before it.
struct Quadratic<const W: usize, const Z: usize> {
    ww: [[f64; W]; W],
    wz: [[f64; Z]; W],
    zz: [[f64; Z]; Z],
}

impl<const W: usize, const Z: usize> Quadratic<W, Z> {
    /// Gives all vehicles the inputs of the first: its rows and columns are the sums over all, and the others' inputs are zero.
    fn share_inputs(&mut self) {
        let (mut ww, mut wz) = ([[0.0; W]; W], [[0.0; Z]; W]);
        for i in 0..W {
            for j in 0..W {
                ww[i % 2][j % 2] += self.ww[i][j];
            }
            for (sum, entry) in wz[i % 2].iter_mut().zip(&self.wz[i]) {
                *sum += entry;
            }
            if i > 1 {
                ww[i][i] = 1.0;
            }
        }
        (self.ww, self.wz) = (ww, wz);
    }
}

impl<const W: usize, const Z: usize> Riccati<W, Z> {
    const VEHICLES: usize = W / 2;

    /// Factors the problem whose second derivatives are given per stage (`hessians[k * M + vehicle]`, `pairs` likewise).
    ///
    /// # Errors
    /// [`StageError::NotConvex`] names the stage at which the problem is unbounded below.
    pub(super) fn factor(
        &mut self,
        qp: &StageQp,
        hessians: &[VehicleHessian],
        pairs: &[PairHessian],
    ) -> Result<(), StageError> {
        let (horizon, width) = (qp.horizon, pairs_among(Self::VEHICLES));
        self.couplings.resize(horizon, [[0.0; Z]; W]);
        self.factors.resize(horizon, Cholesky { lower: [[0.0; W]; W] });
        self.feeds.resize(horizon, [0.0; W]);
        let mut p = [[0.0; Z]; Z];
        for k in (0..horizon).rev() {
            let own = &hessians[k * Self::VEHICLES..(k + 1) * Self::VEHICLES];
            add_stage(&mut p, own, &pairs[k * width..(k + 1) * width]);
            let mut f = Self::quadratic(qp, k, &p, own);
            if k < qp.shared_steps {
                f.share_inputs();
            }
            let factor = Cholesky::new(&f.ww).ok_or(StageError::NotConvex { stage: k })?;
            self.factors[k] = factor;
            factor.forward_all(&mut f.wz);
            self.couplings[k] = f.wz;
            p = f.zz;
            for i in 0..Self::VEHICLES {
                for r in STATE_SIZE * i..STATE_SIZE * (i + 1) {
                    for v in &f.wz {
                        let share = v[r];
                        for (value, v) in p[r].iter_mut().zip(v).take(STATE_SIZE * (i + 1)) {
                            *value -= share * v;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// `F_ww`, `F_wz`, `F_zz` at stage `k` from the cost-to-go `p` of the next one.
    #[inline(always)]
    fn quadratic(qp: &StageQp, k: usize, p: &[[f64; Z]; Z], own: &[VehicleHessian]) -> Quadratic<W, Z> {
        let mut f = Quadratic { ww: [[0.0; W]; W], wz: [[0.0; Z]; W], zz: [[0.0; Z]; Z] };
        for i in 0..Self::VEHICLES {
            for j in 0..=i {
                block_pair(qp, k, [i, j], p, &mut f);
            }
        }
        for i in 0..Self::VEHICLES {
            let (stages, own) = (&qp.vehicles[i], &own[i]);
            let (w, z) = (2 * i, STATE_SIZE * i);
            if k < stages.first {
                for a in w..w + 2 {
                    f.ww[a] = [0.0; W];
                    f.wz[a] = [0.0; Z];
                    for row in &mut f.ww {
                        row[a] = 0.0;
                    }
                    f.ww[a][a] = 1.0;
                }
                continue;
            }
            let c = &stages.curvatures[k];
            for axis in 0..2 {
                let comfort = 2.0 * stages.change_weight(k, axis);
                f.ww[w + axis][w + axis] += comfort + own.input[axis];
                if k > stages.first {
                    f.wz[w + axis][z + 4 + axis] -= comfort;
                    f.zz[z + 4 + axis][z + 4 + axis] += comfort;
                }
            }
            f.ww[w + 1][w + 1] += c.steering_steering;
            f.wz[w + 1][z + 2] += c.heading_steering;
            f.wz[w + 1][z + 3] += c.speed_steering;
            f.zz[z + 2][z + 2] += c.heading_heading;
            f.zz[z + 3][z + 2] += c.heading_speed;
            f.zz[z + 2][z + 3] += c.heading_speed;
        }
        f
    }

    /// Solves for the step that minimises the factored quadratic with the given gradients over `d_{k+1}` and `w_k`.
    pub(super) fn solve(&mut self, qp: &StageQp, gradient: &Point, step: &mut Point) {
        let vehicles = Self::VEHICLES;
        let mut p = [0.0; Z];
        for k in (0..qp.horizon).rev() {
            let mut f_w = [0.0; W];
            let mut carried = [0.0; Z];
            for i in 0..vehicles {
                let (stages, z) = (&qp.vehicles[i], STATE_SIZE * i);
                let pull = gradient.states[k * vehicles + i];
                let row: [f64; 4] = std::array::from_fn(|axis| p[z + axis] + pull[axis]);
                let from_state = times_b(&row, &stages.jacobians[k]);
                if k >= stages.first {
                    for axis in 0..2 {
                        f_w[2 * i + axis] =
                            gradient.inputs[k * vehicles + i][axis] + from_state[axis] + p[z + 4 + axis];
                    }
                }
                carried[z..z + 4].copy_from_slice(&times_a(&row, &stages.jacobians[k]));
            }
            if k < qp.shared_steps {
                let mut shared = [0.0; W];
                f_w.iter().enumerate().for_each(|(i, pull)| shared[i % 2] += pull);
                f_w = shared;
            }
            self.factors[k].forward(&mut f_w);
            self.feeds[k] = f_w;
            p = carried;
            for (v, y) in self.couplings[k].iter().zip(&f_w) {
                for c in 0..Z {
                    p[c] -= v[c] * y;
                }
            }
        }
        self.roll_forward(qp, step);
    }

    fn roll_forward(&self, qp: &StageQp, step: &mut Point) {
        let vehicles = Self::VEHICLES;
        let mut z = [0.0; Z];
        for k in 0..qp.horizon {
            let mut w = self.feeds[k];
            for (w, v) in w.iter_mut().zip(&self.couplings[k]) {
                *w = -v.iter().zip(&z).fold(*w, |sum, (v, z)| sum + v * z);
            }
            self.factors[k].backward(&mut w);
            for i in 0..vehicles {
                let at = STATE_SIZE * i;
                let before = [z[at], z[at + 1], z[at + 2], z[at + 3]];
                let own = if k < qp.shared_steps { 0 } else { 2 * i };
                let input = if k < qp.vehicles[i].first { [0.0; 2] } else { [w[own], w[own + 1]] };
                let state = qp.vehicles[i].jacobians[k].apply(&before, &input);
                z[at..at + 4].copy_from_slice(&state);
                z[at + 4..at + 6].copy_from_slice(&input);
                step.states[k * vehicles + i] = state;
                step.inputs[k * vehicles + i] = input;
            }
        }
    }
}

/// Adds a stage's own second derivatives to the cost-to-go.
#[inline(always)]
fn add_stage<const Z: usize>(p: &mut [[f64; Z]; Z], hessians: &[VehicleHessian], coupling: &[PairHessian]) {
    for (i, h) in hessians.iter().enumerate() {
        let z = STATE_SIZE * i;
        let [xx, xy, xt, yy, yt, tt] = h.pose;
        let pose = [[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]];
        for a in 0..3 {
            for b in 0..3 {
                p[z + a][z + b] += pose[a][b];
            }
        }
        p[z + 3][z + 3] += h.speed;
    }
    for ([i, j], [xx, xy, yy]) in pairs(hessians.len()).zip(coupling) {
        let (zi, zj) = (STATE_SIZE * i, STATE_SIZE * j);
        p[zi][zj] -= xx;
        p[zi][zj + 1] -= xy;
        p[zi + 1][zj] -= xy;
        p[zi + 1][zj + 1] -= yy;
    }
}

/// The contribution of the block `P_ij` (`i ≥ j`) to `F_ww`, `F_wz`, `F_zz`, without the vehicles' own costs.
#[inline(always)]
fn block_pair<const W: usize, const Z: usize>(
    qp: &StageQp,
    k: usize,
    [i, j]: [usize; 2],
    p: &[[f64; Z]; Z],
    f: &mut Quadratic<W, Z>,
) {
    let (a_i, a_j) = (&qp.vehicles[i].jacobians[k], &qp.vehicles[j].jacobians[k]);
    let (zi, zj, wi, wj) = (STATE_SIZE * i, STATE_SIZE * j, 2 * i, 2 * j);
    // Rows of P_ij times A_j and B_j (with the identity of the previous-input part).
    let mut right = [[0.0; 4]; STATE_SIZE];
    let mut into_w = [[0.0; 2]; STATE_SIZE];
    for r in 0..STATE_SIZE {
        let row = &p[zi + r];
        let state = [row[zj], row[zj + 1], row[zj + 2], row[zj + 3]];
        right[r] = times_a(&state, a_j);
        let b = times_b(&state, a_j);
        into_w[r] = [b[0] + row[zj + 4], b[1] + row[zj + 5]];
    }
    for c in 0..4 {
        let column = [right[0][c], right[1][c], right[2][c], right[3][c]];
        let from_state = times_a(&column, a_i);
        for r in 0..4 {
            f.zz[zi + r][zj + c] = from_state[r];
        }
        let from_input = times_b(&column, a_i);
        for r in 0..2 {
            f.wz[wi + r][zj + c] = from_input[r] + right[4 + r][c];
        }
    }
    for c in 0..2 {
        let column = [into_w[0][c], into_w[1][c], into_w[2][c], into_w[3][c]];
        let from_input = times_b(&column, a_i);
        for r in 0..2 {
            let value = from_input[r] + into_w[4 + r][c];
            f.ww[wi + r][wj + c] = value;
            f.ww[wj + c][wi + r] = value;
        }
        if i != j {
            let from_state = times_a(&column, a_i);
            f.wz[wj + c][zi..zi + 4].copy_from_slice(&from_state);
        }
    }
}
