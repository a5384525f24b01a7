//! The LAPACK routines for systems of equations, eigenvalues and singular values.

use std::ffi::{c_char, c_int};
use std::slice::from_raw_parts_mut;

use super::super::jacobi::{NotConverged, SingularValues, eigen, identity, tall_svd};
use super::super::{Operand, factor};
use super::{is, matrix, matrix_mut, size, triangle};

// Clarabel panics where LAPACK reports that an iteration did not converge. That happens with matrices that are not finite,
// which occur on the way to a problem without a solution. The decompositions then return values that make Clarabel's next
// step zero, so that it ends with a status.

/// # Safety
/// As LAPACK documents `dpotrf`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dpotrf_(
    uplo: *const c_char,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: by the contract of `dpotrf` all pointers are valid and A has this size.
    unsafe {
        let (n, ld) = (size(*n), size(*lda));
        *info = code(factor::potrf(triangle(*uplo), n, matrix_mut(a, n, n, ld), ld));
    }
}

/// # Safety
/// As LAPACK documents `dpotrs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dpotrs_(
    uplo: *const c_char,
    n: *const c_int,
    nrhs: *const c_int,
    a: *const f64,
    lda: *const c_int,
    b: *mut f64,
    ldb: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: by the contract of `dpotrs` all pointers are valid, A and B have these sizes and do not overlap.
    unsafe {
        let (n, columns, ld) = (size(*n), size(*nrhs), size(*lda));
        let b = matrix_mut(b, n, columns, size(*ldb));
        factor::potrs(triangle(*uplo), (n, columns), (matrix(a, n, n, ld), ld), b, size(*ldb));
        *info = 0;
    }
}

/// # Safety
/// As LAPACK documents `dgesv`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgesv_(
    n: *const c_int,
    nrhs: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    ipiv: *mut c_int,
    b: *mut f64,
    ldb: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: by the contract of `dgesv` all pointers are valid, and A, B and the n pivots have these sizes and do not
    // overlap.
    unsafe {
        let (n, columns) = (size(*n), size(*nrhs));
        let a = matrix_mut(a, n, n, size(*lda));
        let b = matrix_mut(b, n, columns, size(*ldb));
        let pivots = if n == 0 { &mut [] } else { from_raw_parts_mut(ipiv, n) };
        *info = code(factor::gesv((n, columns), a, size(*lda), pivots, b, size(*ldb)));
    }
}

/// # Safety
/// As LAPACK documents `dgesdd`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgesdd_(
    jobz: *const c_char,
    m: *const c_int,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    s: *mut f64,
    u: *mut f64,
    ldu: *const c_int,
    vt: *mut f64,
    ldvt: *const c_int,
    work: *mut f64,
    lwork: *const c_int,
    _iwork: *mut c_int,
    info: *mut c_int,
) {
    // SAFETY: the contract of `dgesdd` is that of `dgesvd`, with one letter for both sides and an integer workspace that
    // is not used here.
    unsafe { dgesvd_(jobz, jobz, m, n, a, lda, s, u, ldu, vt, ldvt, work, lwork, info) }
}

/// # Safety
/// As LAPACK documents `dgesvd`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgesvd_(
    jobu: *const c_char,
    jobvt: *const c_char,
    m: *const c_int,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    s: *mut f64,
    u: *mut f64,
    ldu: *const c_int,
    vt: *mut f64,
    ldvt: *const c_int,
    work: *mut f64,
    lwork: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: by the contract of `dgesvd` all pointers are valid, and A, S, U and VT have these sizes and do not overlap.
    unsafe {
        *info = match (is(*jobu, b'S'), is(*jobvt, b'S')) {
            (false, _) => -1,
            (_, false) => -2,
            _ => 0,
        };
        if *lwork == -1 {
            // No workspace is needed, but LAPACK returns a size of at least one.
            *work = 1.0;
        }
        if *lwork == -1 || *info != 0 {
            return;
        }
        let (m, n, k) = (size(*m), size(*n), size(*m).min(size(*n)));
        let a = matrix(a, m, n, size(*lda));
        let wide = m < n;
        let (rows, columns) = if wide { (n, m) } else { (m, n) };
        let operand = Operand { entries: a, ld: size(*lda), transposed: wide };
        let tall = (0..columns).flat_map(|j| (0..rows).map(move |i| operand.at(i, j))).collect();
        let failed = || SingularValues {
            u: identity(rows)[..rows * columns].to_vec(),
            sigma: vec![0.0; columns],
            v: identity(columns),
        };
        let SingularValues { u: left, sigma, v: right } =
            tall_svd(rows, columns, tall).unwrap_or_else(|NotConverged| failed());
        let (left, right) = if wide { (right, left) } else { (left, right) };
        matrix_mut(s, k, 1, k).copy_from_slice(&sigma);
        let (u, vt) = (matrix_mut(u, m, k, size(*ldu)), matrix_mut(vt, k, n, size(*ldvt)));
        for l in 0..k {
            for i in 0..m {
                u[i + l * size(*ldu)] = left[i + l * m];
            }
            for j in 0..n {
                vt[l + j * size(*ldvt)] = right[j + l * n];
            }
        }
    }
}

/// # Safety
/// As LAPACK documents `dsyevr`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dsyevr_(
    jobz: *const c_char,
    range: *const c_char,
    uplo: *const c_char,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    _vl: *const f64,
    _vu: *const f64,
    _il: *const c_int,
    _iu: *const c_int,
    _abstol: *const f64,
    m: *mut c_int,
    w: *mut f64,
    z: *mut f64,
    ldz: *const c_int,
    _isuppz: *mut c_int,
    work: *mut f64,
    lwork: *const c_int,
    iwork: *mut c_int,
    liwork: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: by the contract of `dsyevr` all pointers are valid, A and w (and Z when asked for) have these sizes and do
    // not overlap. (The supports of eigenvectors, which the caller does not read, are not written.)
    unsafe {
        *info = if is(*range, b'A') { 0 } else { -2 };
        if *lwork == -1 || *liwork == -1 {
            (*work, *iwork) = (1.0, 1);
            return;
        }
        if *info != 0 {
            return;
        }
        let (n, ld) = (size(*n), size(*lda));
        let (triangle, a) = (triangle(*uplo), matrix(a, n, n, ld));
        let full = (0..n).flat_map(|j| (0..n).map(move |i| triangle.entry(a, ld, i, j))).collect();
        let (values, vectors) = eigen(n, full).unwrap_or_else(|NotConverged| (vec![-f64::MAX; n], identity(n)));
        *m = n as c_int;
        matrix_mut(w, n, 1, n).copy_from_slice(&values);
        if is(*jobz, b'V') {
            let z = matrix_mut(z, n, n, size(*ldz));
            for j in 0..n {
                z[j * size(*ldz)..j * size(*ldz) + n].copy_from_slice(&vectors[j * n..(j + 1) * n]);
            }
        }
    }
}

/// LAPACK's `info`.
fn code(result: Result<(), usize>) -> c_int {
    result.err().map_or(0, |k| k as c_int)
}
