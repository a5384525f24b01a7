//! Learning from neighbours, and the conditions under which it converges (section 5.2, corrected).
//!
//! A zone's cooperative error is its own error plus the differences from the errors of its neighbours (5.1):
//!
//! ```text
//! e_i = E_i + Σ_j∈N(i) (E_i − E_j)           e = Ω E,   Ω = I + the Laplacian of the graph of zones
//! U_k+1 = U_k + L Ω E_k + C (E_k+1 − …)      E_k+1 = (I + GC)⁻¹ (I − G L Ω) E_k    on days that are all the same
//! ```
//!
//! The dissertation calls Ω the adjacency matrix with ones on the diagonal. That matrix has a negative eigenvalue if
//! two neighbours of a zone are not neighbours of each other, and then any uniform L > 0 diverges. The dissertation
//! also equates spectral radius, largest singular value and diagonal. The radius of the block lower triangular matrix
//! is that of its diagonal blocks, max_t ρ(I − B diag(L_i(t,t)) Ω), and decides whether the errors vanish in the end;
//! the largest singular value decides whether they grow before, and may be far above one when the radius is below.

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::powers::{self, largest_singular_value};
use super::stability::spectral_radius;
use crate::lifted::Lifted;

/// Which errors a zone learns from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LearnedErrors {
    /// The zone's own errors.
    #[default]
    Own,
    /// The zone's own errors, and the difference to those of each neighbour (eq. 5.1).
    Neighbours,
    /// The sum of the zone's own errors and those of its neighbours: Ω as the source words it, the adjacency matrix
    /// with ones on its diagonal.
    NeighboursAsPrinted,
}

impl LearnedErrors {
    /// The errors from which each zone learns, given all errors, stacked \[K\]. An error without a weight is left out,
    /// and its zone learns 0.
    pub fn combine(self, lifted: &Lifted, errors_k: &[Option<f64>]) -> Vec<f64> {
        let n = lifted.zones();
        let mut out: Vec<f64> = errors_k.iter().map(|error_k| error_k.unwrap_or(0.0)).collect();
        for (step, errors_k) in out.chunks_exact_mut(n).zip(errors_k.chunks_exact(n)) {
            for &(i, j) in lifted.model().network().adjacent_zones() {
                let (Some(one_k), Some(other_k)) = (errors_k[i], errors_k[j]) else { continue };
                let [for_one_k, for_other_k] = match self {
                    LearnedErrors::Own => [0.0; 2],
                    LearnedErrors::Neighbours => [one_k - other_k, other_k - one_k],
                    LearnedErrors::NeighboursAsPrinted => [other_k, one_k],
                };
                step[i] += for_one_k;
                step[j] += for_other_k;
            }
        }
        out
    }

    /// The same of errors that all have a weight.
    pub(super) fn of_all(self, lifted: &Lifted, errors_k: &[f64]) -> Vec<f64> {
        let weighed: Vec<Option<f64>> = errors_k.iter().copied().map(Some).collect();
        self.combine(lifted, &weighed)
    }
}

/// The matrix Ω that combines the errors of zones, zones by zones.
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

/// The cooperative errors Ω E of stacked errors E (eq. 5.1).
pub fn cooperative_error(lifted: &Lifted, errors_k: &[f64]) -> Vec<f64> {
    LearnedErrors::Neighbours.of_all(lifted, errors_k)
}

/// A learning law L, one lower triangular N by N matrix per zone \[kW/K\].
#[derive(Clone, Debug, PartialEq)]
pub struct LearningLaw(pub Vec<DMatrix<f64>>);

/// The convergence of a learning law from day to day, if all days are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Spectral radius of the map of errors from one day to the next; below one, errors vanish in the end (eq. 5.6,
    /// corrected).
    pub spectral_radius: f64,
    /// Largest singular value of that map; at most one, errors never grow on the way.
    pub largest_singular_value: f64,
}

impl LearningLaw {
    /// The law l (I − aZ) in every zone, with the delay Z of a step; it is of P-type for a = 0.
    pub fn uniform(zones: usize, steps: usize, l: f64, a: f64) -> Self {
        let law = DMatrix::from_fn(steps, steps, |t, s| match t.checked_sub(s) {
            Some(0) => l,
            Some(1) => -l * a,
            _ => 0.0,
        });
        Self(vec![law; zones])
    }

    /// The smallest law that maps yesterday's cooperative errors to the change of the feedforward: row by row, L(t, ·)
    /// = v(t) e(·)ᵀ / ‖e‖² over the errors up to e(t + 1) (eq. 5.3).
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

    /// The change L e of the inputs, for stacked cooperative errors e.
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

    /// The errors of the next day, E_k+1 = (I + GC)⁻¹ (I − G L Ω) E_k, with a feedback of each zone on its own error.
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
            model.step_by_heat(&mut state, &input);
            out.extend((0..n).map(|i| left[t * n + i] - state[i]));
        }
        out
    }

    /// Lᵀ u, for stacked inputs.
    fn transpose_product(&self, heat_kw: &[f64]) -> Vec<f64> {
        let n = self.0.len();
        let mut out = vec![0.0; heat_kw.len()];
        for (i, law) in self.0.iter().enumerate() {
            for (s, column) in law.column_iter().enumerate() {
                out[s * n + i] = column.iter().enumerate().skip(s).map(|(t, l)| l * heat_kw[t * n + i]).sum();
            }
        }
        out
    }

    /// ((I + GC)⁻¹ (I − G L Ω))ᵀ y; Ω is symmetric.
    fn next_errors_transposed(&self, lifted: &Lifted, gain_kw_per_k: f64, y: &[f64]) -> Vec<f64> {
        let fed_back = feedback_transposed(lifted, gain_kw_per_k, y);
        let learned = cooperative_error(lifted, &self.transpose_product(&lifted.transpose_product(&fed_back)));
        fed_back.iter().zip(learned).map(|(y, learned)| y - learned).collect()
    }

    /// The convergence conditions, from products with sparse matrices: for any number of zones.
    pub fn conditions(&self, lifted: &Lifted, gain_kw_per_k: f64) -> Conditions {
        // (I + GC)⁻¹ begins with identities on its diagonal: the feedback acts a step later.
        let radius = |t: usize| {
            block_radius(lifted, |errors_k| {
                let learned = cooperative_error(lifted, errors_k);
                learned.iter().zip(&self.0).map(|(error_k, law)| law[(t, t)] * error_k).collect()
            })
        };
        Conditions {
            spectral_radius: (0..lifted.steps()).map(radius).fold(0.0, f64::max),
            largest_singular_value: largest_singular_value(
                lifted.size(),
                |x| self.next_errors_k(lifted, gain_kw_per_k, x),
                |y| self.next_errors_transposed(lifted, gain_kw_per_k, y),
            ),
        }
    }
}

/// The largest number of zones for which the spectral radius is computed from the matrix itself.
const MOST_DENSE_ZONES: usize = 64;

/// ρ(I − h₁ L), for what a law makes of the errors of one step \[kW\]: h₁ is the rise of all zones a step after one kilowatt.
pub(super) fn block_radius(lifted: &Lifted, learned_kw: impl Fn(&[f64]) -> Vec<f64>) -> f64 {
    let (n, model) = (lifted.zones(), lifted.model());
    let product = |errors_k: &[f64]| -> Vec<f64> {
        let mut heat_kw = learned_kw(errors_k);
        heat_kw.resize(model.network().node_count(), 0.0);
        errors_k.iter().zip(model.gain_product(&heat_kw)).map(|(error_k, rise_k)| error_k - rise_k).collect()
    };
    if n > MOST_DENSE_ZONES {
        return powers::spectral_radius(n, product);
    }
    let mut block = DMatrix::zeros(n, n);
    let mut unit = vec![0.0; n];
    for column in 0..n {
        unit[column] = 1.0;
        block.column_mut(column).copy_from_slice(&product(&unit));
        unit[column] = 0.0;
    }
    spectral_radius(&block)
}

/// ((I + GC)⁻¹)ᵀ y, for a feedback of each zone on its own error: backwards in time.
fn feedback_transposed(lifted: &Lifted, gain_kw_per_k: f64, y: &[f64]) -> Vec<f64> {
    let (n, model) = (lifted.zones(), lifted.model());
    let mut costate = vec![0.0; model.network().node_count()];
    let mut out = y.to_vec();
    for step in out.chunks_exact_mut(n).rev() {
        let answered = model.gain_product(&costate);
        costate = model.state_transpose_product(&costate);
        for (i, out) in step.iter_mut().enumerate() {
            *out += gain_kw_per_k * answered[i];
            costate[i] -= *out;
        }
    }
    out
}
