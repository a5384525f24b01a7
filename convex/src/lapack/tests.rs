//! Calls every symbol by its Fortran name with random numbers, and compares the result with its definition.

#![allow(unsafe_code, reason = "the symbols are called as a foreign interface calls them")]

use std::ffi::{c_char, c_int};

use nalgebra::DMatrix;
use proptest::prelude::*;

use super::symbols::*;

const LOOSE: usize = 2;

/// A matrix with a leading dimension larger than its number of rows; the entries between the columns are NaN.
fn stored(matrix: &DMatrix<f64>) -> (Vec<f64>, c_int) {
    let ld = matrix.nrows() + LOOSE;
    let mut entries = vec![f64::NAN; ld * matrix.ncols()];
    for j in 0..matrix.ncols() {
        for i in 0..matrix.nrows() {
            entries[i + j * ld] = matrix[(i, j)];
        }
    }
    (entries, ld as c_int)
}

fn loaded(rows: usize, columns: usize, entries: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |i, j| entries[i + j * (rows + LOOSE)])
}

/// The same, with NaN in the triangle that must not be read.
fn triangle_of(matrix: &DMatrix<f64>, upper: bool) -> DMatrix<f64> {
    DMatrix::from_fn(
        matrix.nrows(),
        matrix.ncols(),
        |i, j| {
            if i == j || (i < j) == upper { matrix[(i, j)] } else { f64::NAN }
        },
    )
}

fn letter(value: u8) -> *const c_char {
    match value {
        b'N' => c"N".as_ptr(),
        b'T' => c"T".as_ptr(),
        b'U' => c"U".as_ptr(),
        b'L' => c"L".as_ptr(),
        b'S' => c"S".as_ptr(),
        b'A' => c"A".as_ptr(),
        _ => c"V".as_ptr(),
    }
}

fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = DMatrix<f64>> {
    proptest::collection::vec(-2.0..2.0, rows * columns).prop_map(move |v| DMatrix::from_vec(rows, columns, v))
}

fn close(a: &DMatrix<f64>, b: &DMatrix<f64>) -> bool {
    (a - b).amax() <= 1e-11 * (1.0 + b.amax())
}

/// Equality on one triangle, and the other one untouched (NaN).
fn close_triangle(a: &DMatrix<f64>, b: &DMatrix<f64>, upper: bool) -> bool {
    let n = a.nrows();
    (0..n).all(|j| {
        (0..n).all(
            |i| {
                if i == j || (i < j) == upper { (a[(i, j)] - b[(i, j)]).abs() < 1e-11 } else { a[(i, j)].is_nan() }
            },
        )
    })
}

fn flag(value: bool) -> u8 {
    if value { b'T' } else { b'N' }
}

fn side(upper: bool) -> u8 {
    if upper { b'U' } else { b'L' }
}

proptest! {
    #[test]
    fn gemm_matches_nalgebra(a in matrix(3, 5), b in matrix(5, 4), c in matrix(3, 4), ta: bool, tb: bool, beta in prop_oneof![Just(0.0), -1.0..1.0]) {
        let (alpha, sizes) = (0.7, [3 as c_int, 4, 5]);
        let (sa, lda) = stored(&if ta { a.transpose() } else { a.clone() });
        let (sb, ldb) = stored(&if tb { b.transpose() } else { b.clone() });
        let (mut sc, ldc) = stored(&if beta == 0.0 { c.map(|_| f64::NAN) } else { c.clone() });
        // SAFETY: all sizes are those of the vectors.
        unsafe {
            dgemm_(letter(flag(ta)), letter(flag(tb)), &sizes[0], &sizes[1], &sizes[2], &alpha, sa.as_ptr(), &lda,
                sb.as_ptr(), &ldb, &beta, sc.as_mut_ptr(), &ldc);
        }
        let wanted = &a * &b * alpha + c * beta;
        prop_assert!(close(&loaded(3, 4, &sc), &wanted));
    }

    #[test]
    fn gemv_matches_nalgebra(a in matrix(3, 5), x in matrix(5, 1), y in matrix(3, 1), transposed: bool) {
        let (alpha, beta, two, one) = (-1.5, 0.5, 2 as c_int, 1 as c_int);
        let (sa, lda) = stored(&if transposed { a.transpose() } else { a.clone() });
        let (m, n) = if transposed { (5, 3) } else { (3, 5) };
        let spread: Vec<f64> = x.iter().flat_map(|&x| [x, f64::NAN]).collect();
        let mut sy: Vec<f64> = y.iter().copied().collect();
        // SAFETY: all sizes are those of the vectors.
        unsafe {
            dgemv_(letter(flag(transposed)), &m, &n, &alpha, sa.as_ptr(), &lda, spread.as_ptr(), &two, &beta,
                sy.as_mut_ptr(), &one);
        }
        prop_assert!(close(&DMatrix::from_vec(3, 1, sy), &(&a * &x * alpha + y * beta)));
    }

    #[test]
    fn symv_matches_nalgebra(a in matrix(4, 4), x in matrix(4, 1), y in matrix(4, 1), upper: bool) {
        let (alpha, beta, one, n) = (2.0, -0.5, 1 as c_int, 4 as c_int);
        let symmetric = &a + a.transpose();
        let (sa, lda) = stored(&triangle_of(&symmetric, upper));
        let mut sy: Vec<f64> = y.iter().copied().collect();
        // SAFETY: all sizes are those of the vectors.
        unsafe {
            dsymv_(letter(side(upper)), &n, &alpha, sa.as_ptr(), &lda, x.as_ptr(), &one, &beta, sy.as_mut_ptr(), &one);
        }
        prop_assert!(close(&DMatrix::from_vec(4, 1, sy), &(&symmetric * &x * alpha + y * beta)));
    }

    #[test]
    fn syrk_and_syr2k_match_nalgebra(a in matrix(4, 3), b in matrix(4, 3), c in matrix(4, 4), upper: bool, transposed: bool) {
        let (alpha, beta, n, k) = (0.5, -2.0, 4 as c_int, 3 as c_int);
        let symmetric = &c + c.transpose();
        let form = |m: &DMatrix<f64>| stored(&if transposed { m.transpose() } else { m.clone() });
        let ((sa, lda), (sb, ldb)) = (form(&a), form(&b));
        let (mut one, ldc) = stored(&triangle_of(&symmetric, upper));
        let mut two = one.clone();
        // SAFETY: all sizes are those of the vectors.
        unsafe {
            dsyrk_(letter(side(upper)), letter(flag(transposed)), &n, &k, &alpha, sa.as_ptr(), &lda, &beta,
                one.as_mut_ptr(), &ldc);
            dsyr2k_(letter(side(upper)), letter(flag(transposed)), &n, &k, &alpha, sa.as_ptr(), &lda, sb.as_ptr(), &ldb,
                &beta, two.as_mut_ptr(), &ldc);
        }
        let rank_k = &a * a.transpose() * alpha + &symmetric * beta;
        let rank_2k = (&a * b.transpose() + &b * a.transpose()) * alpha + &symmetric * beta;
        prop_assert!(close_triangle(&loaded(4, 4, &one), &rank_k, upper));
        prop_assert!(close_triangle(&loaded(4, 4, &two), &rank_2k, upper));
    }

    #[test]
    fn potrf_and_potrs_factor_and_solve(root in matrix(5, 5), b in matrix(5, 2), upper: bool) {
        let a = &root * root.transpose() + DMatrix::identity(5, 5);
        let (mut sa, lda) = stored(&triangle_of(&a, upper));
        let (mut sb, ldb) = stored(&b);
        let (n, columns, mut info) = (5 as c_int, 2 as c_int, -9);
        // SAFETY: all sizes are those of the vectors.
        unsafe {
            dpotrf_(letter(side(upper)), &n, sa.as_mut_ptr(), &lda, &mut info);
            prop_assert_eq!(info, 0);
            dpotrs_(letter(side(upper)), &n, &columns, sa.as_ptr(), &lda, sb.as_mut_ptr(), &ldb, &mut info);
        }
        let factor = loaded(5, 5, &sa).map_with_location(|i, j, v| if i == j || (i < j) == upper { v } else { 0.0 });
        let product = if upper { factor.transpose() * &factor } else { &factor * factor.transpose() };
        prop_assert!(close(&product, &a));
        prop_assert!(close(&(&a * loaded(5, 2, &sb)), &b));
    }

    #[test]
    fn gesv_solves_linear_systems(a in matrix(5, 5), b in matrix(5, 2)) {
        prop_assume!(a.clone().svd(false, false).singular_values.min() > 0.05);
        let ((mut sa, lda), (mut sb, ldb)) = (stored(&a), stored(&b));
        let (n, columns, mut info, mut pivots) = (5 as c_int, 2 as c_int, -9, [0 as c_int; 5]);
        // SAFETY: all sizes are those of the vectors.
        unsafe {
            dgesv_(&n, &columns, sa.as_mut_ptr(), &lda, pivots.as_mut_ptr(), sb.as_mut_ptr(), &ldb, &mut info);
        }
        prop_assert_eq!(info, 0);
        prop_assert!((&a * loaded(5, 2, &sb) - &b).amax() < 1e-10);
        prop_assert!(pivots.iter().enumerate().all(|(j, &p)| p as usize > j && p <= 5));
    }

    #[test]
    fn singular_values_match_nalgebra(entries in matrix(6, 4), wide: bool, deficient: bool, divide: bool) {
        let mut a = entries;
        if deficient {
            let copy = a.column(0).clone_owned();
            a.set_column(3, &copy);
        }
        let a = if wide { a.transpose() } else { a };
        let (m, n) = a.shape();
        let ((mut sa, lda), (mut su, ldu), (mut svt, ldvt)) =
            (stored(&a), stored(&DMatrix::zeros(m, 4)), stored(&DMatrix::zeros(4, n)));
        let (cm, cn, mut s, mut work, mut iwork, mut info) = (m as c_int, n as c_int, [0.0; 4], [0.0; 9], [0; 32], -9);
        for lwork in [-1, 9] {
            // SAFETY: all sizes are those of the vectors.
            unsafe {
                if divide {
                    dgesdd_(letter(b'S'), &cm, &cn, sa.as_mut_ptr(), &lda, s.as_mut_ptr(), su.as_mut_ptr(), &ldu,
                        svt.as_mut_ptr(), &ldvt, work.as_mut_ptr(), &lwork, iwork.as_mut_ptr(), &mut info);
                } else {
                    dgesvd_(letter(b'S'), letter(b'S'), &cm, &cn, sa.as_mut_ptr(), &lda, s.as_mut_ptr(),
                        su.as_mut_ptr(), &ldu, svt.as_mut_ptr(), &ldvt, work.as_mut_ptr(), &lwork, &mut info);
                }
            }
            prop_assert_eq!(info, 0);
            prop_assert!(work[0] >= 1.0);
        }
        let (u, vt) = (loaded(m, 4, &su), loaded(4, n, &svt));
        let wanted = a.clone().svd(false, false).singular_values;
        prop_assert!(s.iter().zip(wanted.iter()).all(|(s, wanted)| (s - wanted).abs() < 1e-11));
        prop_assert!(close(&(&u * DMatrix::from_diagonal(&s.to_vec().into()) * &vt), &a));
        prop_assert!(close(&(u.transpose() * &u), &DMatrix::identity(4, 4)));
        prop_assert!(close(&(&vt * vt.transpose()), &DMatrix::identity(4, 4)));
    }

    #[test]
    fn eigenvalues_and_eigenvectors_decompose_the_matrix(entries in matrix(5, 5), upper: bool, low_rank: bool) {
        let a = if low_rank {
            let thin = entries.columns(0, 2).into_owned();
            &thin * thin.transpose()
        } else {
            &entries + entries.transpose()
        };
        let (mut sa, lda) = stored(&triangle_of(&a, upper));
        let (mut z, ldz) = stored(&DMatrix::zeros(5, 5));
        let (n, zero, none, mut m, mut info) = (5 as c_int, 0.0, 0 as c_int, 0, -9);
        let (mut w, mut work, mut iwork, mut support) = ([0.0; 5], [0.0; 9], [0 as c_int; 9], [0 as c_int; 10]);
        for length in [-1, 9] {
            // SAFETY: all sizes are those of the vectors.
            unsafe {
                dsyevr_(letter(b'V'), letter(b'A'), letter(side(upper)), &n, sa.as_mut_ptr(), &lda, &zero, &zero, &none,
                    &none, &zero, &mut m, w.as_mut_ptr(), z.as_mut_ptr(), &ldz, support.as_mut_ptr(),
                    work.as_mut_ptr(), &length, iwork.as_mut_ptr(), &length, &mut info);
            }
            prop_assert_eq!(info, 0);
        }
        let z = loaded(5, 5, &z);
        prop_assert_eq!(m, 5);
        prop_assert!(w.is_sorted());
        prop_assert!(close(&(&z * DMatrix::from_diagonal(&w.to_vec().into()) * z.transpose()), &a));
        prop_assert!(close(&(z.transpose() * &z), &DMatrix::identity(5, 5)));
    }
}

#[test]
fn failures_return_the_codes_of_lapack() {
    let (n, one, mut info, mut pivots) = (2 as c_int, 1 as c_int, -9, [0 as c_int; 2]);
    let mut indefinite = [1.0, 2.0, 2.0, 1.0];
    let mut singular = [1.0, 2.0, 2.0, 4.0];
    let mut b = [1.0, 1.0];
    // SAFETY: all sizes are those of the arrays.
    unsafe {
        dpotrf_(letter(b'L'), &n, indefinite.as_mut_ptr(), &n, &mut info);
        assert_eq!(info, 2, "the second leading minor is negative");
        dgesv_(&n, &one, singular.as_mut_ptr(), &n, pivots.as_mut_ptr(), b.as_mut_ptr(), &n, &mut info);
        assert_eq!(info, 2, "the second pivot vanishes");
        let (mut a, mut s, mut u, mut vt, mut work) = ([f64::NAN; 4], [0.0; 2], [0.0; 4], [0.0; 4], [0.0; 1]);
        let mut svd = |job| {
            dgesvd_(
                letter(job),
                letter(job),
                &n,
                &n,
                a.as_mut_ptr(),
                &n,
                s.as_mut_ptr(),
                u.as_mut_ptr(),
                &n,
                vt.as_mut_ptr(),
                &n,
                work.as_mut_ptr(),
                &one,
                &mut info,
            );
            info
        };
        assert_eq!(svd(b'A'), -1, "only economic singular vectors are supported");
        assert_eq!(svd(b'S'), 0, "Clarabel panics at another code");
        assert_eq!(s, [0.0; 2], "a NaN has no singular values");
    }
}
