//! The causal feedback of least expected cost under an uncertain disturbance (step 1).
//!
//! With the disturbance off by δ ~ N(0, Σ), inputs move by −(I − Y) δ and errors by −G Y δ, so the expectation of J exceeds
//! its nominal value by
//!
//! ```text
//! tr(W_e G Y Σ Yᵀ Gᵀ) + tr(W_u (I − Y) Σ (I − Y)ᵀ),        Y = (I + CG)⁻¹             (eq. 3.10)
//! ```
//!
//! C is causal exactly when Y is unit block lower triangular. With Σ = LLᵀ and V = (Y − I) L, which is strictly block lower,
//! the cost is ‖W_e^½ G (L + V)‖² + ‖W_u^½ V‖², a sum over the columns of V: each of the N − 1 block columns is a small
//! linear system with a trailing block of H = Gᵀ W_e G + W_u. With H = RRᵀ, R *upper* triangular, the factor of a
//! trailing block is that of R, so that one factorisation is enough.
//!
//! Without causality the optimum would be C* = W_u⁻¹ Gᵀ W_e, which uses future errors only.

use nalgebra::DMatrix;

use crate::comfort::Targets;
use crate::control::ControlError;
use crate::lifted::Lifted;

/// The response to a disturbance of unit covariance in each of q directions under feedback. Both n·N by q.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// Responses of the temperatures, G Y L \[K\]; errors are their negatives.
    pub temperatures_k: DMatrix<f64>,
    /// Responses of the inputs, −(I − Y) L \[kW\].
    pub inputs_kw: DMatrix<f64>,
}

impl Response {
    /// The expected cost that the disturbance adds to the nominal cost.
    pub fn cost(&self, targets: &Targets) -> f64 {
        let mut cost = 0.0;
        for (temperatures_k, inputs_kw) in self.temperatures_k.column_iter().zip(self.inputs_kw.column_iter()) {
            for (i, (t, u)) in temperatures_k.iter().zip(&inputs_kw).enumerate() {
                cost += targets.error_weight[i] * t * t + targets.input_weight[i] * u * u;
            }
        }
        cost
    }

    /// Standard deviations of the inputs \[kW\], stacked.
    pub fn input_deviation_kw(&self) -> Vec<f64> {
        row_norms(&self.inputs_kw)
    }

    /// Standard deviations of the temperatures \[K\], stacked.
    pub(crate) fn temperature_deviation_k(&self) -> Vec<f64> {
        row_norms(&self.temperatures_k)
    }
}

fn row_norms(matrix: &DMatrix<f64>) -> Vec<f64> {
    let mut squares = vec![0.0; matrix.nrows()];
    for column in matrix.column_iter() {
        for (square, value) in squares.iter_mut().zip(&column) {
            *square += value * value;
        }
    }
    squares.into_iter().map(f64::sqrt).collect()
}

/// The response under the causal feedback with the least expected cost. `factor` is L with Σ = LLᵀ; `price` is added to
/// W_u for each input, and may be empty (see [`super::joint`]).
///
/// # Errors
/// [`ControlError::Covariance`] if H is not positive definite: W_u is zero.
pub fn optimal_causal(
    lifted: &Lifted,
    targets: &Targets,
    factor: &DMatrix<f64>,
    price: &[f64],
) -> Result<Response, ControlError> {
    let (n, size) = (lifted.zones(), lifted.size());
    let mut curvature = curvature(lifted, targets);
    for (i, price) in price.iter().enumerate() {
        curvature[(i, i)] += price;
    }
    let root = upper_factor(curvature).ok_or(ControlError::Covariance { order: size })?;
    let mut response = Response { temperatures_k: DMatrix::zeros(size, size), inputs_kw: DMatrix::zeros(size, size) };
    for column in 0..size {
        let disturbance = factor.column(column).clone_owned();
        let start = (column / n + 1) * n;
        let pull = weighted_twice(lifted, targets, disturbance.as_slice());
        let mut v = vec![0.0; size];
        v[start..].copy_from_slice(&pull[start..]);
        solve_trailing(&root, start, &mut v[start..]);
        for v in &mut v {
            *v = -*v;
        }
        let net: Vec<f64> = v.iter().zip(&disturbance).map(|(v, l)| v + l).collect();
        response.temperatures_k.column_mut(column).copy_from_slice(&lifted.product(&net));
        response.inputs_kw.column_mut(column).copy_from_slice(&v);
    }
    Ok(response)
}

/// The response under u(t) = K e(t), K zones by zones \[kW/K\]; at t = 0 no error is known.
pub fn static_feedback(lifted: &Lifted, gain: &DMatrix<f64>, factor: &DMatrix<f64>) -> Response {
    let (model, n) = (lifted.model(), lifted.zones());
    let nodes = model.network().node_count();
    let q = factor.ncols();
    let mut response =
        Response { temperatures_k: DMatrix::zeros(lifted.size(), q), inputs_kw: DMatrix::zeros(lifted.size(), q) };
    for column in 0..q {
        let mut state = vec![0.0; nodes];
        for t in 0..lifted.steps() {
            let mut input = vec![0.0; n];
            for (j, &rise) in state[..n].iter().enumerate() {
                for (input, gain) in input.iter_mut().zip(&gain.column(j)) {
                    *input -= gain * rise;
                }
            }
            let net: Vec<f64> = (0..n).map(|i| input[i] + factor[(t * n + i, column)]).collect();
            model.step_by_heat(&mut state, &net);
            for i in 0..n {
                response.temperatures_k[(t * n + i, column)] = state[i];
                response.inputs_kw[(t * n + i, column)] = input[i];
            }
        }
    }
    response
}

/// Gᵀ W_e G x.
fn weighted_twice(lifted: &Lifted, targets: &Targets, x: &[f64]) -> Vec<f64> {
    let mut risen = lifted.product(x);
    for (risen, weight) in risen.iter_mut().zip(&targets.error_weight) {
        *risen *= weight;
    }
    lifted.transpose_product(&risen)
}

/// H = Gᵀ W_e G + W_u.
fn curvature(lifted: &Lifted, targets: &Targets) -> DMatrix<f64> {
    let size = lifted.size();
    let mut unit = vec![0.0; size];
    let mut matrix = DMatrix::zeros(size, size);
    for column in 0..size {
        unit[column] = 1.0;
        matrix.column_mut(column).copy_from_slice(&weighted_twice(lifted, targets, &unit));
        matrix[(column, column)] += targets.input_weight[column];
        unit[column] = 0.0;
    }
    matrix
}

/// R upper triangular with H = RRᵀ, from the upper triangle of H, if H is positive definite.
fn upper_factor(mut matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = matrix.ncols();
    for j in (0..size).rev() {
        let pivot = matrix[(j, j)];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        let root = pivot.sqrt();
        matrix[(j, j)] = root;
        matrix.view_mut((0, j), (j, 1)).unscale_mut(root);
        let (before, column) = matrix.as_mut_slice().split_at_mut(j * size);
        for k in 0..j {
            let factor = column[k];
            for (entry, value) in before[k * size..k * size + k + 1].iter_mut().zip(column.iter()) {
                *entry -= factor * value;
            }
        }
    }
    Some(matrix)
}

/// Solves with the trailing block of H from `start`, in place.
fn solve_trailing(root: &DMatrix<f64>, start: usize, x: &mut [f64]) {
    let size = root.ncols();
    let column = |j: usize| &root.as_slice()[j * size + start..j * size + j];
    for j in (start..size).rev() {
        let value = x[j - start] / root[(j, j)];
        x[j - start] = value;
        for (x, r) in x.iter_mut().zip(column(j)) {
            *x -= value * r;
        }
    }
    for j in start..size {
        let known: f64 = column(j).iter().zip(x.iter()).map(|(r, x)| r * x).sum();
        x[j - start] = (x[j - start] - known) / root[(j, j)];
    }
}
