//! Rates and modes of a network.
//!
//! C⁻¹L is similar to the symmetric S = C^-½ L C^-½ = V diag(λ) Vᵀ, so the modes decay independently at real rates λ ≥ 0,
//! and any function of C⁻¹L is C^-½ V diag(f(λ)) Vᵀ C^½.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::network::Network;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spectrum {
    /// λ, ascending \[1/s\].
    rates_per_s: DVector<f64>,
    /// C^-½ V, a mode per column.
    modes: DMatrix<f64>,
}

impl Spectrum {
    pub(super) fn compute(network: &Network) -> Self {
        let eigen = SymmetricEigen::new(symmetric(network));
        let order = ascending(&eigen.eigenvalues);
        let inverse_root = inverse_root(network);
        let n = network.node_count();
        Self {
            rates_per_s: DVector::from_fn(n, |mode, _| eigen.eigenvalues[order[mode]].max(0.0)),
            modes: DMatrix::from_fn(n, n, |node, mode| inverse_root[node] * eigen.eigenvectors[(node, order[mode])]),
        }
    }

    /// f(C⁻¹L)·C⁻¹ = C^-½ V diag(f(λ)) Vᵀ C^-½, which is symmetric.
    ///
    /// Written out, because the rounding of nalgebra's product of large matrices depends on the processor.
    pub(super) fn function(&self, f: impl Fn(f64) -> f64) -> DMatrix<f64> {
        let n = self.modes.nrows();
        let mut out = DMatrix::zeros(n, n);
        for (mode, rate) in self.modes.column_iter().zip(self.rates_per_s.iter()) {
            let weight = f(*rate);
            for j in 0..n {
                let scale = weight * mode[j];
                out.column_mut(j).axpy(scale, &mode, 1.0);
            }
        }
        // Copying makes the matrix exactly symmetric, whatever the order of the roundings.
        out.fill_upper_triangle_with_lower_triangle();
        out
    }
}

/// Rates λ of all modes, ascending \[1/s\].
pub(super) fn rates_per_s(network: &Network) -> Vec<f64> {
    let values = symmetric(network).symmetric_eigenvalues();
    ascending(&values).into_iter().map(|mode| values[mode].max(0.0)).collect()
}

/// A bound on every rate from Gershgorin's circles: twice the fastest node's own rate \[1/s\].
pub(super) fn rate_bound_per_s(network: &Network) -> f64 {
    network.node_time_constants_s().iter().fold(0.0, |bound: f64, time_constant_s| bound.max(2.0 / time_constant_s))
}

/// S = C^-½ L C^-½.
fn symmetric(network: &Network) -> DMatrix<f64> {
    let root = inverse_root(network);
    let mut matrix = network.laplacian();
    for j in 0..matrix.ncols() {
        for i in 0..matrix.nrows() {
            matrix[(i, j)] *= root[i] * root[j];
        }
    }
    matrix
}

/// Diagonal of C^-½.
pub(super) fn inverse_root(network: &Network) -> Vec<f64> {
    network.capacities_kj_per_k().iter().map(|capacity| 1.0 / capacity.sqrt()).collect()
}

fn ascending(values: &DVector<f64>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    order
}
