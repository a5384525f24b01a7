//! Matrix products of BLAS. As in BLAS, old values are not read if β = 0.

use super::{Operand, Triangle};

/// β y + increment, without reading y when β is zero.
fn updated(beta: f64, old: f64, increment: f64) -> f64 {
    if beta == 0.0 { increment } else { beta * old + increment }
}

/// C ← α op(A) op(B) + β C, where op(A) is m × k and op(B) is k × n.
pub(super) fn gemm(
    (m, n, k): (usize, usize, usize),
    alpha: f64,
    a: Operand<'_>,
    b: Operand<'_>,
    beta: f64,
    c: &mut [f64],
    ldc: usize,
) {
    for j in 0..n {
        for i in 0..m {
            let sum: f64 = (0..k).map(|l| a.at(i, l) * b.at(l, j)).sum();
            let c = &mut c[i + j * ldc];
            *c = updated(beta, *c, alpha * sum);
        }
    }
}

/// y ← α op(A) x + β y, where op(A) has `rows` rows; the entries of x are `stride_x` apart, those of y `stride_y`.
pub(super) fn gemv(
    (rows, columns): (usize, usize),
    alpha: f64,
    a: Operand<'_>,
    (x, stride_x): (&[f64], usize),
    beta: f64,
    (y, stride_y): (&mut [f64], usize),
) {
    for i in 0..rows {
        let sum: f64 = (0..columns).map(|j| a.at(i, j) * x[j * stride_x]).sum();
        let y = &mut y[i * stride_y];
        *y = updated(beta, *y, alpha * sum);
    }
}

/// y ← α A x + β y for a symmetric A, of which one triangle is read.
pub(super) fn symv(
    triangle: Triangle,
    n: usize,
    alpha: f64,
    (a, lda): (&[f64], usize),
    (x, stride_x): (&[f64], usize),
    beta: f64,
    (y, stride_y): (&mut [f64], usize),
) {
    for i in 0..n {
        let sum: f64 = (0..n).map(|j| triangle.entry(a, lda, i, j) * x[j * stride_x]).sum();
        let y = &mut y[i * stride_y];
        *y = updated(beta, *y, alpha * sum);
    }
}

/// C ← α op(A) op(A)ᵀ + β C in one triangle, where op(A) is n × k.
pub(super) fn syrk(
    triangle: Triangle,
    (n, k): (usize, usize),
    alpha: f64,
    a: Operand<'_>,
    beta: f64,
    c: &mut [f64],
    ldc: usize,
) {
    for j in 0..n {
        for i in triangle.rows(j, n) {
            let sum: f64 = (0..k).map(|l| a.at(i, l) * a.at(j, l)).sum();
            let c = &mut c[i + j * ldc];
            *c = updated(beta, *c, alpha * sum);
        }
    }
}

/// C ← α (op(A) op(B)ᵀ + op(B) op(A)ᵀ) + β C in one triangle, where op(A) and op(B) are n × k.
pub(super) fn syr2k(
    triangle: Triangle,
    (n, k): (usize, usize),
    alpha: f64,
    (a, b): (Operand<'_>, Operand<'_>),
    beta: f64,
    c: &mut [f64],
    ldc: usize,
) {
    for j in 0..n {
        for i in triangle.rows(j, n) {
            let sum: f64 = (0..k).map(|l| a.at(i, l) * b.at(j, l) + b.at(i, l) * a.at(j, l)).sum();
            let c = &mut c[i + j * ldc];
            *c = updated(beta, *c, alpha * sum);
        }
    }
}
