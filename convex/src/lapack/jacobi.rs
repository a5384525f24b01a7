//! Eigenvalues and singular values by Jacobi's plane rotations. The method is too slow for large matrices, but highly
//! accurate.

/// Maximum number of sweeps; matrices of order 100 need about ten.
const SWEEPS: usize = 60;

/// The error that a diagonalisation or a singular value decomposition did not converge, because an entry is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotConverged;

/// A = U diag(σ) Vᵀ, by columns: U (m × n), σ descending, V (n × n).
pub(super) struct SingularValues {
    pub(super) u: Vec<f64>,
    pub(super) sigma: Vec<f64>,
    pub(super) v: Vec<f64>,
}

/// The rotation (c, s) that makes two vectors orthogonal, from their squared lengths and their inner product.
fn rotation(alpha: f64, beta: f64, gamma: f64) -> (f64, f64) {
    let zeta = (beta - alpha) / (2.0 * gamma);
    let tangent = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    (cosine, cosine * tangent)
}

/// x, y ← c x − s y, s x + c y for the columns p and q (p < q) of a matrix of `rows` rows.
fn rotate(matrix: &mut [f64], rows: usize, p: usize, q: usize, (c, s): (f64, f64)) {
    let (left, right) = matrix.split_at_mut(q * rows);
    for (x, y) in left[p * rows..(p + 1) * rows].iter_mut().zip(&mut right[..rows]) {
        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
    }
}

/// Eigenvalues, ascending, and orthonormal eigenvectors by columns of the symmetric n × n matrix `a` (both triangles).
pub(crate) fn eigen(n: usize, mut a: Vec<f64>) -> Result<(Vec<f64>, Vec<f64>), NotConverged> {
    let mut vectors = identity(n);
    let norm = a.iter().map(|v| v * v).sum::<f64>().sqrt();
    if !norm.is_finite() {
        return Err(NotConverged);
    }
    let negligible = f64::EPSILON * norm;
    let mut converged = false;
    for _ in 0..SWEEPS {
        converged = true;
        for p in 0..n {
            for q in p + 1..n {
                let off = a[p + q * n];
                if off.abs() <= negligible {
                    continue;
                }
                converged = false;
                let turn = rotation(a[p + p * n], a[q + q * n], off);
                rotate(&mut a, n, p, q, turn);
                transpose_rotate(&mut a, n, p, q, turn);
                (a[p + q * n], a[q + p * n]) = (0.0, 0.0);
                rotate(&mut vectors, n, p, q, turn);
            }
        }
        if converged {
            break;
        }
    }
    if !converged {
        return Err(NotConverged);
    }
    let values: Vec<f64> = (0..n).map(|i| a[i + i * n]).collect();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| values[i].total_cmp(&values[j]));
    let sorted = order.iter().flat_map(|&i| vectors[i * n..(i + 1) * n].to_vec()).collect();
    Ok((order.iter().map(|&i| values[i]).collect(), sorted))
}

/// The same rotation on the rows p and q.
fn transpose_rotate(a: &mut [f64], n: usize, p: usize, q: usize, (c, s): (f64, f64)) {
    for column in a.chunks_exact_mut(n) {
        (column[p], column[q]) = (c * column[p] - s * column[q], s * column[p] + c * column[q]);
    }
}

/// The decomposition of an m × n matrix with m ≥ n. Columns of U for vanishing σ complete the others to orthonormal ones.
pub(super) fn tall_svd(m: usize, n: usize, mut a: Vec<f64>) -> Result<SingularValues, NotConverged> {
    let mut v = identity(n);
    if a.iter().any(|value| !value.is_finite()) {
        return Err(NotConverged);
    }
    // Largest rounding error of the inner product of two orthogonal columns.
    let rows_epsilon = f64::EPSILON * m as f64;
    let mut converged = false;
    for _ in 0..SWEEPS {
        converged = true;
        for p in 0..n {
            for q in p + 1..n {
                let (x, y) = (&a[p * m..(p + 1) * m], &a[q * m..(q + 1) * m]);
                let (alpha, beta, gamma) = (dot(x, x), dot(y, y), dot(x, y));
                if gamma.abs() <= rows_epsilon * (alpha * beta).sqrt() || gamma == 0.0 {
                    continue;
                }
                converged = false;
                let turn = rotation(alpha, beta, gamma);
                rotate(&mut a, m, p, q, turn);
                rotate(&mut v, n, p, q, turn);
            }
        }
        if converged {
            break;
        }
    }
    if !converged {
        return Err(NotConverged);
    }
    let lengths: Vec<f64> = a.chunks_exact(m.max(1)).map(|column| dot(column, column).sqrt()).collect();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| lengths[j].total_cmp(&lengths[i]));
    let sigma: Vec<f64> = order.iter().map(|&i| lengths[i]).collect();
    let largest = sigma.first().copied().unwrap_or(0.0);
    let mut u: Vec<f64> = Vec::with_capacity(m * n);
    for (&i, &sigma) in order.iter().zip(&sigma) {
        if sigma > f64::EPSILON * f64::EPSILON * largest && sigma > f64::MIN_POSITIVE {
            u.extend(a[i * m..(i + 1) * m].iter().map(|value| value / sigma));
        } else {
            let missing = complement(m, &u);
            u.extend(missing);
        }
    }
    let v = order.iter().flat_map(|&i| v[i * n..(i + 1) * n].to_vec()).collect();
    Ok(SingularValues { u, sigma, v })
}

/// A unit vector that is orthogonal to the given orthonormal ones, fewer than m.
fn complement(m: usize, basis: &[f64]) -> Vec<f64> {
    let mut best = vec![0.0; m];
    let mut best_length = 0.0;
    for axis in 0..m {
        let mut candidate = vec![0.0; m];
        candidate[axis] = 1.0;
        // Orthogonalising twice removes the rounding errors of the first time.
        for _ in 0..2 {
            for column in basis.chunks_exact(m) {
                let part = dot(column, &candidate);
                for (candidate, column) in candidate.iter_mut().zip(column) {
                    *candidate -= part * column;
                }
            }
        }
        let length = dot(&candidate, &candidate).sqrt();
        if length > best_length {
            best_length = length;
            best = candidate;
        }
    }
    best.iter().map(|value| value / best_length).collect()
}

pub(super) fn identity(n: usize) -> Vec<f64> {
    (0..n * n).map(|k| if k % (n + 1) == 0 { 1.0 } else { 0.0 }).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
