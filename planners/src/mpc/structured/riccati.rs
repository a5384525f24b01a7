//! Unconstrained stage problems over the dynamics of `M` bicycles: a factorisation and a solve.
//!
//! The state of a vehicle at stage `k` is `(d_k, w_{k−1})` ∈ ℝ⁶ because the comfort cost couples inputs of neighbouring
//! stages. With the cost-to-go `½ zᵀP z + pᵀz`, `P` made of 6×6 blocks, one stage back is
//!
//! ```text
//! F_ww = BᵀPB + 2R + …,   F_wz = BᵀPA − 2R (previous input),   F_zz = AᵀPA + 2R (previous input)
//! K = −F_ww⁻¹ F_wz,       P ← F_zz + F_wzᵀ K
//! ```
//!
//! Vehicles meet only where rows of a pair fill the off-diagonal blocks of `P`.

use super::rows::Point;
use crate::dynamics::Jacobian;
use crate::mpc::stage::{StageError, StageQp};

/// Number of states of a vehicle with its previous input.
const BLOCK: usize = 6;

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

/// Coupling between the positions of two vehicles at one stage: minus the Hessian over `p_i − p_j`.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairHessian {
    /// The two vehicles, the larger index first.
    pub pair: [usize; 2],
    /// Over the difference: xx, xy, yy.
    pub position: [f64; 3],
}

/// Factors of a stage problem of `W/2` vehicles; `Z = 3 W`.
#[derive(Clone, Debug)]
pub(super) struct Riccati<const W: usize, const Z: usize> {
    gains: Vec<[[f64; Z]; W]>,
    factors: Vec<Cholesky<W>>,
    feed_forward: Vec<[f64; W]>,
}

impl<const W: usize, const Z: usize> Default for Riccati<W, Z> {
    fn default() -> Self {
        Riccati { gains: Vec::new(), factors: Vec::new(), feed_forward: Vec::new() }
    }
}

/// Lower Cholesky factor with reciprocal diagonal.
#[derive(Clone, Copy, Debug)]
struct Cholesky<const W: usize> {
    lower: [[f64; W]; W],
}

impl<const W: usize> Cholesky<W> {
    /// Factors the lower triangle of `matrix`; `None` if it is not positive definite.
    #[inline(always)]
    fn new(matrix: &[[f64; W]; W]) -> Option<Self> {
        let mut lower = *matrix;
        for j in 0..W {
            let mut pivot = lower[j][j];
            for k in 0..j {
                pivot -= lower[j][k] * lower[j][k];
            }
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            let inverse = 1.0 / pivot.sqrt();
            lower[j][j] = inverse;
            for i in j + 1..W {
                let mut value = lower[i][j];
                for k in 0..j {
                    value -= lower[i][k] * lower[j][k];
                }
                lower[i][j] = value * inverse;
            }
        }
        Some(Cholesky { lower })
    }

    #[inline(always)]
    fn solve(&self, rhs: &mut [f64; W]) {
        for i in 0..W {
            for k in 0..i {
                rhs[i] -= self.lower[i][k] * rhs[k];
            }
            rhs[i] *= self.lower[i][i];
        }
        for i in (0..W).rev() {
            for k in i + 1..W {
                rhs[i] -= self.lower[k][i] * rhs[k];
            }
            rhs[i] *= self.lower[i][i];
        }
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

impl<const W: usize, const Z: usize> Riccati<W, Z> {
    const VEHICLES: usize = W / 2;

    /// Factors the problem whose second derivatives are given per stage (`hessians[k * M + vehicle]`, `pairs[k]`).
    ///
    /// # Errors
    /// [`StageError::NotConvex`] names the stage at which the problem is unbounded below.
    pub(super) fn factor(
        &mut self,
        qp: &StageQp,
        hessians: &[VehicleHessian],
        pairs: &[Vec<PairHessian>],
    ) -> Result<(), StageError> {
        let horizon = qp.horizon;
        self.gains.resize(horizon, [[0.0; Z]; W]);
        self.factors.resize(horizon, Cholesky { lower: [[0.0; W]; W] });
        self.feed_forward.resize(horizon, [0.0; W]);
        let mut p = [[0.0; Z]; Z];
        for k in (0..horizon).rev() {
            add_stage::<Z>(&mut p, &hessians[k * Self::VEHICLES..(k + 1) * Self::VEHICLES], &pairs[k]);
            let Quadratic { ww: f_ww, wz: f_wz, zz: f_zz } = Self::quadratic(qp, k, &p, hessians);
            let factor = Cholesky::new(&f_ww).ok_or(StageError::NotConvex { stage: k })?;
            self.factors[k] = factor;
            if k == 0 {
                break; // d_0 = 0: nothing to feed back
            }
            let gain = &mut self.gains[k];
            for column in 0..Z {
                let mut rhs: [f64; W] = std::array::from_fn(|row| -f_wz[row][column]);
                factor.solve(&mut rhs);
                for row in 0..W {
                    gain[row][column] = rhs[row];
                }
            }
            for i in 0..Z {
                for j in 0..=i {
                    let mut value = f_zz[i][j];
                    for row in 0..W {
                        value += f_wz[row][i] * gain[row][j];
                    }
                    p[i][j] = value;
                    p[j][i] = value;
                }
            }
        }
        Ok(())
    }

    /// `F_ww`, `F_wz`, `F_zz` at stage `k` from the cost-to-go `p` of the next one.
    #[inline(always)]
    fn quadratic(qp: &StageQp, k: usize, p: &[[f64; Z]; Z], hessians: &[VehicleHessian]) -> Quadratic<W, Z> {
        let mut f = Quadratic { ww: [[0.0; W]; W], wz: [[0.0; Z]; W], zz: [[0.0; Z]; Z] };
        for i in 0..Self::VEHICLES {
            for j in 0..=i {
                block_pair(qp, k, [i, j], p, &mut f);
            }
        }
        for i in 0..Self::VEHICLES {
            let (stages, own) = (&qp.vehicles[i], &hessians[k * Self::VEHICLES + i]);
            let (w, z) = (2 * i, BLOCK * i);
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
                let comfort = 2.0 * stages.change_weights[axis];
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
                let (stages, z) = (&qp.vehicles[i], BLOCK * i);
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
            let mut feed: [f64; W] = std::array::from_fn(|row| -f_w[row]);
            self.factors[k].solve(&mut feed);
            self.feed_forward[k] = feed;
            if k == 0 {
                break;
            }
            let gain = &self.gains[k];
            for column in 0..Z {
                let mut value = carried[column];
                for row in 0..W {
                    value += gain[row][column] * f_w[row];
                }
                p[column] = value;
            }
        }
        self.roll_forward(qp, step);
    }

    fn roll_forward(&self, qp: &StageQp, step: &mut Point) {
        let vehicles = Self::VEHICLES;
        let mut z = [0.0; Z];
        for k in 0..qp.horizon {
            let mut w = self.feed_forward[k];
            if k > 0 {
                for row in 0..W {
                    for column in 0..Z {
                        w[row] += self.gains[k][row][column] * z[column];
                    }
                }
            }
            for i in 0..vehicles {
                let at = BLOCK * i;
                let before = [z[at], z[at + 1], z[at + 2], z[at + 3]];
                let input = if k < qp.vehicles[i].first { [0.0; 2] } else { [w[2 * i], w[2 * i + 1]] };
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
fn add_stage<const Z: usize>(p: &mut [[f64; Z]; Z], hessians: &[VehicleHessian], pairs: &[PairHessian]) {
    for (i, h) in hessians.iter().enumerate() {
        let z = BLOCK * i;
        let [xx, xy, xt, yy, yt, tt] = h.pose;
        let pose = [[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]];
        for a in 0..3 {
            for b in 0..3 {
                p[z + a][z + b] += pose[a][b];
            }
        }
        p[z + 3][z + 3] += h.speed;
    }
    for PairHessian { pair: [i, j], position: [xx, xy, yy] } in pairs {
        let (zi, zj) = (BLOCK * i, BLOCK * j);
        let position = [[xx, xy], [xy, yy]];
        for a in 0..2 {
            for b in 0..2 {
                p[zi + a][zj + b] -= position[a][b];
                p[zj + b][zi + a] -= position[a][b];
            }
        }
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
    let (zi, zj, wi, wj) = (BLOCK * i, BLOCK * j, 2 * i, 2 * j);
    // Rows of P_ij times A_j and B_j (with the identity of the previous-input part).
    let mut right = [[0.0; 4]; BLOCK];
    let mut into_w = [[0.0; 2]; BLOCK];
    for r in 0..BLOCK {
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
            f.zz[zj + c][zi + r] = from_state[r];
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
