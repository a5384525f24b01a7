//! The BLAS and LAPACK routines that Clarabel calls for its cone of positive semidefinite matrices, in Rust.
//!
//! Clarabel links them by their Fortran names. Usually a system library provides them. Here this module does, so that the
//! build needs no Fortran compiler, no library and no download. The matrices are small (their order is twice the number of
//! zones), so the simplest accurate algorithms suffice: products by loops, Cholesky, LU with pivoting, and Jacobi rotations
//! for eigenvalues and singular values. Plain loops also give bit-identical results on every processor; libraries that
//! choose their instructions at run time do not.
//!
//! [`symbols`] is the only module with `unsafe`: it turns pointers into slices and calls the safe code beside it.
//! Matrices are slices by columns with a leading dimension, as in Fortran: entry (i, j) is `a[i + j * ld]`.

mod factor;
mod jacobi;
mod products;
mod symbols;
#[cfg(test)]
mod tests;

pub(crate) use jacobi::eigen;

/// Which triangle of a symmetric matrix is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Triangle {
    Upper,
    Lower,
}

impl Triangle {
    /// The triangle that a Fortran argument names by its first letter, `U` or `L`.
    fn from_letter(letter: u8) -> Option<Self> {
        match letter.to_ascii_uppercase() {
            b'U' => Some(Self::Upper),
            b'L' => Some(Self::Lower),
            _ => None,
        }
    }

    /// The rows of column `j` that are stored, of `n`.
    fn rows(self, j: usize, n: usize) -> std::ops::Range<usize> {
        match self {
            Self::Upper => 0..j + 1,
            Self::Lower => j..n,
        }
    }

    /// The entry (i, j) of the symmetric matrix.
    fn entry(self, a: &[f64], ld: usize, i: usize, j: usize) -> f64 {
        let (low, high) = (i.min(j), i.max(j));
        match self {
            Self::Upper => a[low + high * ld],
            Self::Lower => a[high + low * ld],
        }
    }
}

/// A matrix to be read, perhaps transposed.
#[derive(Debug, Clone, Copy)]
struct Operand<'a> {
    entries: &'a [f64],
    ld: usize,
    transposed: bool,
}

impl Operand<'_> {
    fn at(&self, i: usize, j: usize) -> f64 {
        if self.transposed { self.entries[j + i * self.ld] } else { self.entries[i + j * self.ld] }
    }
}
