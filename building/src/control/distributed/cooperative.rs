//! Learning from neighbours, and when it converges (section 5.2, corrected).
//!
//! A zone's cooperative error adds how much worse it fares than its neighbours (5.1):
//!
//! ```text
//! e_i = E_i + Σ_j∈N(i) (E_i − E_j)           e = Ω E,   Ω = I + the Laplacian of the graph of zones
//! U_k+1 = U_k + L Ω E_k + C (E_k+1 − …)      E_k+1 = (I + GC)⁻¹ (I − G L Ω) E_k    on days that are all the same
//! ```
//!
//! The source calls Ω the adjacency matrix with ones on the diagonal. That has negative eigenvalues, and any uniform L > 0
//! diverges. It also equates spectral radius, largest singular value and diagonal. The radius of the block lower triangular
//! matrix is that of its diagonal blocks, max_t ρ(I − B diag(L_i(t,t)) Ω), and decides the end; the largest singular value
//! decides whether errors grow on the way, and may be far above one when the radius is below.

use nalgebra::DMatrix;

use crate::control::stability::spectral_radius;
use crate::lifted::Lifted;

/// Ω, zones by zones.
pub fn omega(lifted: &Lifted) -> DMatrix<f64> {
    let n = lifted.zones();
    let mut omega = DMatrix::identity(n, n);
    for &(i, j) in lifted.model().network().adjacent_zones() {
        omega[(i, i)] += 1.0;
        omega[(j, j)] += 1.0;
        omega[(i, j)] -= 1.0;
        omega[(j, i)] -= 1.0;
    }
    omega
}

/// Ω E, for stacked errors: what (5.1) asks of neighbours.
pub fn cooperative_error(lifted: &Lifted, errors_k: &[f64]) -> Vec<f64> {
    let n = lifted.zones();
    let mut out = errors_k.to_vec();
    for (step, errors_k) in out.chunks_exact_mut(n).zip(errors_k.chunks_exact(n)) {
        for &(i, j) in lifted.model().network().adjacent_zones() {
            step[i] += errors_k[i] - errors_k[j];
            step[j] += errors_k[j] - errors_k[i];
        }
    }
    out
}

/// A learning law L, one lower triangular N by N matrix per zone \[kW/K\].
#[derive(Clone, Debug, PartialEq)]
pub struct LearningLaw(pub Vec<DMatrix<f64>>);

/// What a learning law does to the errors of days that are all the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Below one, errors vanish in the end (eq. 5.6, corrected).
    pub spectral_radius: f64,
    /// At most one, they never grow on the way.
    pub largest_singular_value: f64,
}

impl LearningLaw {
    /// l (I − aZ) in every zone, Z the delay by a step: P-type for a = 0.
    pub fn uniform(zones: usize, steps: usize, l: f64, a: f64) -> Self {
        let law = DMatrix::from_fn(steps, steps, |t, s| match t.checked_sub(s) {
            Some(0) => l,
            Some(1) => -l * a,
            _ => 0.0,
        });
        Self(vec![law; zones])
    }

    /// The smallest law that turns yesterday's cooperative errors into the change of the feedforward: row by row,
    /// L(t, ·) = v(t) e(·)ᵀ / ‖e‖² over the errors up to e(t + 1) (eq. 5.3).
    pub fn recovered(zones: usize, change_kw: &[f64], cooperative_k: &[f64]) -> Self {
        let steps = change_kw.len() / zones;
        let law = |i: usize| {
            let mut law = DMatrix::zeros(steps, steps);
            let mut square = 0.0;
            for t in 0..steps {
                square += cooperative_k[t * zones + i] * cooperative_k[t * zones + i];
                if square > 0.0 {
                    for s in 0..=t {
                        law[(t, s)] = change_kw[t * zones + i] * cooperative_k[s * zones + i] / square;
                    }
                }
            }
            law
        };
        Self((0..zones).map(law).collect())
    }

    /// L e, for stacked cooperative errors.
    pub fn product(&self, cooperative_k: &[f64]) -> Vec<f64> {
        let n = self.0.len();
        let mut out = vec![0.0; cooperative_k.len()];
        for (i, law) in self.0.iter().enumerate() {
            for (s, column) in law.column_iter().enumerate() {
                for (t, l) in column.iter().enumerate().skip(s) {
                    out[t * n + i] += l * cooperative_k[s * n + i];
                }
            }
        }
        out
    }

    /// E_k+1 = (I + GC)⁻¹ (I − G L Ω) E_k, for a feedback of each zone on its own error.
    pub fn next_errors_k(&self, lifted: &Lifted, gain_kw_per_k: f64, errors_k: &[f64]) -> Vec<f64> {
        let n = lifted.zones();
        let learned = self.product(&cooperative_error(lifted, errors_k));
        let left: Vec<f64> = errors_k.iter().zip(lifted.product(&learned)).map(|(e, rise)| e - rise).collect();
        if gain_kw_per_k == 0.0 {
            return left;
        }
        // (I + GC) x = left, forwards in time: x(t+1) = left(t+1) − G(u), u(t) = K x(t).
        let model = lifted.model();
        let mut state = vec![0.0; model.network().node_count()];
        let mut out: Vec<f64> = Vec::with_capacity(left.len());
        for t in 0..lifted.steps() {
            let input: Vec<f64> =
                (0..n).map(|i| if t == 0 { 0.0 } else { gain_kw_per_k * out[(t - 1) * n + i] }).collect();
            model.step(&mut state, &input, 0.0, &vec![0.0; n]);
            out.extend((0..n).map(|i| left[t * n + i] - state[i]));
        }
        out
    }

    /// The convergence conditions. Time and memory in the square of n·N and more.
    pub fn conditions(&self, lifted: &Lifted, gain_kw_per_k: f64) -> Conditions {
        let (n, size) = (lifted.zones(), lifted.size());
        let mut map = DMatrix::zeros(size, size);
        let mut unit = vec![0.0; size];
        for column in 0..size {
            unit[column] = 1.0;
            map.column_mut(column).copy_from_slice(&self.next_errors_k(lifted, gain_kw_per_k, &unit));
            unit[column] = 0.0;
        }
        let block = |t: usize| spectral_radius(&map.view((t * n, t * n), (n, n)).into_owned());
        Conditions {
            spectral_radius: (0..lifted.steps()).map(block).fold(0.0, f64::max),
            largest_singular_value: largest_singular_value(&map),
        }
    }
}

/// ‖M‖₂ by the power method on MᵀM, to about six digits.
fn largest_singular_value(map: &DMatrix<f64>) -> f64 {
    let size = map.ncols();
    let mut x = nalgebra::DVector::from_fn(size, |i, _| 1.0 + libm::sin(i as f64));
    let mut value = 0.0;
    for _ in 0..300 {
        x.unscale_mut(x.norm());
        let mut image = nalgebra::DVector::zeros(map.nrows());
        for (column, x) in map.column_iter().zip(&x) {
            image.axpy(*x, &column, 1.0);
        }
        let before = std::mem::replace(&mut value, image.norm());
        if (value - before).abs() <= 1e-9 * value {
            break;
        }
        x = map.tr_mul(&image);
    }
    value
}
