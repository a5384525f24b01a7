//! Factorisations that solve systems (LAPACK). Errors are LAPACK's `info`: the number of the first pivot that failed,
//! from one.

use super::Triangle;

/// A = LLᵀ or A = UᵀU in the stored triangle, in place. Err(k): the leading minor of order k is not positive.
pub(super) fn potrf(triangle: Triangle, n: usize, a: &mut [f64], lda: usize) -> Result<(), usize> {
    // Entry (i, j) of the lower factor; U is its transpose.
    let place = |i: usize, j: usize| match triangle {
        Triangle::Lower => i + j * lda,
        Triangle::Upper => j + i * lda,
    };
    for j in 0..n {
        let known: f64 = (0..j).map(|k| a[place(j, k)] * a[place(j, k)]).sum();
        let pivot = a[place(j, j)] - known;
        // A NaN fails, too.
        if !(pivot > 0.0 && pivot.is_finite()) {
            return Err(j + 1);
        }
        let root = pivot.sqrt();
        a[place(j, j)] = root;
        for i in j + 1..n {
            let known: f64 = (0..j).map(|k| a[place(i, k)] * a[place(j, k)]).sum();
            a[place(i, j)] = (a[place(i, j)] - known) / root;
        }
    }
    Ok(())
}

/// Solves A X = B in place of B, with the factor of [`potrf`].
pub(super) fn potrs(
    triangle: Triangle,
    (n, columns): (usize, usize),
    (a, lda): (&[f64], usize),
    b: &mut [f64],
    ldb: usize,
) {
    let lower = |i: usize, j: usize| match triangle {
        Triangle::Lower => a[i + j * lda],
        Triangle::Upper => a[j + i * lda],
    };
    for x in b.chunks_mut(ldb.max(1)).take(columns) {
        for i in 0..n {
            let known: f64 = (0..i).map(|k| lower(i, k) * x[k]).sum();
            x[i] = (x[i] - known) / lower(i, i);
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| lower(k, i) * x[k]).sum();
            x[i] = (x[i] - known) / lower(i, i);
        }
    }
}

/// P A = L U with partial pivoting in place of A, then solves A X = B in place of B. `pivots` are the rows that were
/// exchanged, from one. Err(k): the k-th pivot is zero, and nothing was solved.
pub(super) fn gesv(
    (n, columns): (usize, usize),
    a: &mut [f64],
    lda: usize,
    pivots: &mut [i32],
    b: &mut [f64],
    ldb: usize,
) -> Result<(), usize> {
    let mut singular = None;
    for j in 0..n {
        let largest = (j..n).fold(j, |best, i| if a[i + j * lda].abs() > a[best + j * lda].abs() { i } else { best });
        pivots[j] = largest as i32 + 1;
        for column in 0..n {
            a.swap(j + column * lda, largest + column * lda);
        }
        if a[j + j * lda] == 0.0 {
            singular = singular.or(Some(j + 1));
            continue;
        }
        for i in j + 1..n {
            a[i + j * lda] /= a[j + j * lda];
            for column in j + 1..n {
                a[i + column * lda] -= a[i + j * lda] * a[j + column * lda];
            }
        }
    }
    if let Some(k) = singular {
        return Err(k);
    }
    for x in b.chunks_mut(ldb.max(1)).take(columns) {
        for i in 0..n {
            x.swap(i, pivots[i] as usize - 1);
        }
        for i in 0..n {
            let known: f64 = (0..i).map(|k| a[i + k * lda] * x[k]).sum();
            x[i] -= known;
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| a[i + k * lda] * x[k]).sum();
            x[i] = (x[i] - known) / a[i + i * lda];
        }
    }
    Ok(())
}
