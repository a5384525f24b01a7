//! The products of BLAS.

use std::ffi::{c_char, c_int};

use super::super::{Operand, products};
use super::{matrix, matrix_mut, size, stride, transposed, triangle};

/// # Safety
/// As BLAS documents `dgemm`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgemm_(
    transa: *const c_char,
    transb: *const c_char,
    m: *const c_int,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    b: *const f64,
    ldb: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    // SAFETY: by the contract of `dgemm` all pointers are valid, A and B have these sizes, and C overlaps neither.
    unsafe {
        let (m, n, k) = (size(*m), size(*n), size(*k));
        let operand = |start, transposed: bool, rows, columns, ld| {
            let (rows, columns) = if transposed { (columns, rows) } else { (rows, columns) };
            Operand { entries: matrix(start, rows, columns, ld), ld, transposed }
        };
        let a = operand(a, transposed(*transa), m, k, size(*lda));
        let b = operand(b, transposed(*transb), k, n, size(*ldb));
        let c = matrix_mut(c, m, n, size(*ldc));
        products::gemm((m, n, k), *alpha, a, b, *beta, c, size(*ldc));
    }
}

/// # Safety
/// As BLAS documents `dgemv`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgemv_(
    trans: *const c_char,
    m: *const c_int,
    n: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    x: *const f64,
    incx: *const c_int,
    beta: *const f64,
    y: *mut f64,
    incy: *const c_int,
) {
    // SAFETY: by the contract of `dgemv` all pointers are valid, A, x and y have these sizes, and y overlaps neither.
    unsafe {
        let (m, n, ld) = (size(*m), size(*n), size(*lda));
        let a = Operand { entries: matrix(a, m, n, ld), ld, transposed: transposed(*trans) };
        let (rows, columns) = if a.transposed { (n, m) } else { (m, n) };
        let x = (matrix(x, 1, columns, stride(*incx)), stride(*incx));
        let y = (matrix_mut(y, 1, rows, stride(*incy)), stride(*incy));
        products::gemv((rows, columns), *alpha, a, x, *beta, y);
    }
}

/// # Safety
/// As BLAS documents `dsymv`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dsymv_(
    uplo: *const c_char,
    n: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    x: *const f64,
    incx: *const c_int,
    beta: *const f64,
    y: *mut f64,
    incy: *const c_int,
) {
    // SAFETY: by the contract of `dsymv` all pointers are valid, A, x and y have these sizes, and y overlaps neither.
    unsafe {
        let (n, ld) = (size(*n), size(*lda));
        let x = (matrix(x, 1, n, stride(*incx)), stride(*incx));
        let y = (matrix_mut(y, 1, n, stride(*incy)), stride(*incy));
        products::symv(triangle(*uplo), n, *alpha, (matrix(a, n, n, ld), ld), x, *beta, y);
    }
}

/// # Safety
/// As BLAS documents `dsyrk`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dsyrk_(
    uplo: *const c_char,
    trans: *const c_char,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    // SAFETY: by the contract of `dsyrk` all pointers are valid, A and C have these sizes and do not overlap.
    unsafe {
        let (n, k, ld) = (size(*n), size(*k), size(*lda));
        let transposed = transposed(*trans);
        let (rows, columns) = if transposed { (k, n) } else { (n, k) };
        let a = Operand { entries: matrix(a, rows, columns, ld), ld, transposed };
        let c = matrix_mut(c, n, n, size(*ldc));
        products::syrk(triangle(*uplo), (n, k), *alpha, a, *beta, c, size(*ldc));
    }
}

/// # Safety
/// As BLAS documents `dsyr2k`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dsyr2k_(
    uplo: *const c_char,
    trans: *const c_char,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    b: *const f64,
    ldb: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    // SAFETY: by the contract of `dsyr2k` all pointers are valid, A, B and C have these sizes, and C overlaps neither.
    unsafe {
        let (n, k) = (size(*n), size(*k));
        let transposed = transposed(*trans);
        let (rows, columns) = if transposed { (k, n) } else { (n, k) };
        let a = Operand { entries: matrix(a, rows, columns, size(*lda)), ld: size(*lda), transposed };
        let b = Operand { entries: matrix(b, rows, columns, size(*ldb)), ld: size(*ldb), transposed };
        let c = matrix_mut(c, n, n, size(*ldc));
        products::syr2k(triangle(*uplo), (n, k), *alpha, (a, b), *beta, c, size(*ldc));
    }
}
