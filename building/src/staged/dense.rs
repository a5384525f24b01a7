//! Products and factors of small dense matrices, with sums in a fixed order.
//!
//! All of them use one kernel: columns of a target accumulate multiples of the columns of a source, four at a time.
//! Without fused multiplication, the result is the same on every machine.

use nalgebra::DMatrix;

/// Columns that the kernel handles together. Chosen: the sixteen weights and eight columns stay in registers and first-level cache.
const BLOCK: usize = 4;

/// The first `columns` columns of `target` take up `Σₖ source[:, k] weight(k, j)`. Both have `rows` rows and are stored by columns.
/// Of the columns from `j` to `j + 3`, rows above `from(j)` are left alone.
pub(super) fn accumulate(
    target: &mut [f64],
    source: &[f64],
    rows: usize,
    from: impl Fn(usize) -> usize,
    weight: impl Fn(usize, usize) -> f64,
) {
    let count = source.len() / rows.max(1);
    for (block, columns) in target.chunks_mut(BLOCK * rows).enumerate() {
        let first = block * BLOCK;
        let from = from(first);
        let width = columns.len() / rows;
        for k in (0..count).step_by(BLOCK) {
            let depth = BLOCK.min(count - k);
            if width == BLOCK && depth == BLOCK {
                let mut weights = [[0.0; BLOCK]; BLOCK];
                for (j, weights) in weights.iter_mut().enumerate() {
                    for (l, value) in weights.iter_mut().enumerate() {
                        *value = weight(k + l, first + j);
                    }
                }
                accumulate_block(columns, &source[k * rows..(k + BLOCK) * rows], rows, from, &weights);
            } else {
                for (j, column) in columns.chunks_mut(rows).enumerate() {
                    for l in k..k + depth {
                        let value = weight(l, first + j);
                        let added = &source[l * rows + from..(l + 1) * rows];
                        column[from..].iter_mut().zip(added).for_each(|(target, source)| *target += value * source);
                    }
                }
            }
        }
    }
}

/// Four columns take up multiples of four columns.
fn accumulate_block(target: &mut [f64], source: &[f64], rows: usize, from: usize, weights: &[[f64; BLOCK]; BLOCK]) {
    let (t0, rest) = target.split_at_mut(rows);
    let (t1, rest) = rest.split_at_mut(rows);
    let (t2, t3) = rest.split_at_mut(rows);
    let (t0, t1, t2, t3) = (&mut t0[from..], &mut t1[from..], &mut t2[from..], &mut t3[from..rows]);
    let [s0, s1, s2, s3] = [0, 1, 2, 3].map(|k| &source[k * rows + from..(k + 1) * rows]);
    let length = t0.len();
    let (t1, t2, t3) = (&mut t1[..length], &mut t2[..length], &mut t3[..length]);
    let (s0, s1, s2, s3) = (&s0[..length], &s1[..length], &s2[..length], &s3[..length]);
    let [w0, w1, w2, w3] = *weights;
    for i in 0..length {
        let (a, b, c, d) = (s0[i], s1[i], s2[i], s3[i]);
        t0[i] = t0[i] + w0[0] * a + w0[1] * b + w0[2] * c + w0[3] * d;
        t1[i] = t1[i] + w1[0] * a + w1[1] * b + w1[2] * c + w1[3] * d;
        t2[i] = t2[i] + w2[0] * a + w2[1] * b + w2[2] * c + w2[3] * d;
        t3[i] = t3[i] + w3[0] * a + w3[1] * b + w3[2] * c + w3[3] * d;
    }
}

/// Σ aᵢ bᵢ, in order.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::zeros(a.nrows(), b.ncols());
    accumulate(product.as_mut_slice(), a.as_slice(), a.nrows(), |_| 0, |k, j| b[(k, j)]);
    product
}

/// The product A B, where it is known to be symmetric.
pub(crate) fn symmetric_product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::zeros(a.nrows(), b.ncols());
    accumulate(product.as_mut_slice(), a.as_slice(), a.nrows(), |j| j, |k, j| b[(k, j)]);
    mirror(&mut product);
    product
}

/// Subtracts Y Yᵀ from a symmetric matrix.
pub(super) fn subtract_square(matrix: &mut DMatrix<f64>, y: &DMatrix<f64>) {
    accumulate(matrix.as_mut_slice(), y.as_slice(), y.nrows(), |j| j, |k, j| -y[(j, k)]);
    mirror(matrix);
}

/// Copies what lies below the diagonal to above it.
fn mirror(matrix: &mut DMatrix<f64>) {
    for j in 0..matrix.ncols() {
        for i in 0..j {
            matrix[(i, j)] = matrix[(j, i)];
        }
    }
}

/// The lower triangular L with R = L Lᵀ, in place of the lower triangle of R; `None` if R is not positive definite.
pub(crate) fn cholesky(mut matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = matrix.nrows();
    for first in (0..size).step_by(BLOCK) {
        let width = BLOCK.min(size - first);
        let (before, rest) = matrix.as_mut_slice().split_at_mut(first * size);
        let columns = &mut rest[..width * size];
        let before = &*before;
        accumulate(columns, before, size, |_| first, |k, j| -before[k * size + first + j]);
        for j in 0..width {
            let (done, column) = columns.split_at_mut(j * size);
            let column = &mut column[first + j..size];
            for earlier in done.chunks(size) {
                let factor = earlier[first + j];
                column.iter_mut().zip(&earlier[first + j..]).for_each(|(entry, l)| *entry -= factor * l);
            }
            if !(column[0] > 0.0 && column[0].is_finite()) {
                return None;
            }
            let root = column[0].sqrt();
            column.iter_mut().for_each(|entry| *entry /= root);
        }
    }
    Some(matrix)
}

/// Solves Y Lᵀ = M for Y in place of M, with L lower triangular.
pub(super) fn solve_right(l: &DMatrix<f64>, m: &mut DMatrix<f64>) {
    let (rows, size) = (m.nrows(), l.nrows());
    for first in (0..size).step_by(BLOCK) {
        let width = BLOCK.min(size - first);
        let (before, rest) = m.as_mut_slice().split_at_mut(first * rows);
        let columns = &mut rest[..width * rows];
        accumulate(columns, before, rows, |_| 0, |k, j| -l[(first + j, k)]);
        for j in 0..width {
            let (done, column) = columns.split_at_mut(j * rows);
            let column = &mut column[..rows];
            for (k, earlier) in done.chunks(rows).enumerate() {
                let factor = l[(first + j, first + k)];
                column.iter_mut().zip(earlier).for_each(|(entry, y)| *entry -= factor * y);
            }
            let pivot = l[(first + j, first + j)];
            column.iter_mut().for_each(|entry| *entry /= pivot);
        }
    }
}

/// Solves L x = b in place.
pub(super) fn solve_lower(l: &DMatrix<f64>, x: &mut [f64]) {
    for j in 0..x.len() {
        x[j] /= l[(j, j)];
        let value = x[j];
        let column = &l.as_slice()[j * l.nrows()..(j + 1) * l.nrows()];
        x[j + 1..].iter_mut().zip(&column[j + 1..]).for_each(|(x, l)| *x -= value * l);
    }
}

/// Solves Lᵀ x = b in place.
pub(super) fn solve_lower_transposed(l: &DMatrix<f64>, x: &mut [f64]) {
    for j in (0..x.len()).rev() {
        let column = &l.as_slice()[j * l.nrows()..(j + 1) * l.nrows()];
        let known: f64 = column[j + 1..].iter().zip(&x[j + 1..]).map(|(l, x)| l * x).sum();
        x[j] = (x[j] - known) / column[j];
    }
}

/// y + scale · M x, in place of y.
pub(super) fn add_product(m: &DMatrix<f64>, x: &[f64], scale: f64, y: &mut [f64]) {
    accumulate(y, m.as_slice(), m.nrows(), |_| 0, |k, _| scale * x[k]);
}

/// Mᵀ x.
pub(super) fn transposed_product(m: &DMatrix<f64>, x: &[f64]) -> Vec<f64> {
    m.as_slice().chunks(m.nrows().max(1)).map(|column| column.iter().zip(x).map(|(m, x)| m * x).sum()).collect()
}
