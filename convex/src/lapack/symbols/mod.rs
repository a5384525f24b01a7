//! The symbols under their Fortran names. Every argument is a pointer; matrices are stored by columns.
//!
//! The contract is that of the reference BLAS and LAPACK, as far as Clarabel uses it: strides are positive, singular
//! vectors are the economic ones (`S`), eigenvalues are all (`A`). Any other argument returns LAPACK's `info` for an
//! illegal argument. Routines without `info` end the program with a message, as the reference does.

#![allow(
    unsafe_code,
    reason = "symbols that a foreign interface looks up by name, and its pointers, need it; nothing else does"
)]
#![allow(clippy::too_many_arguments, reason = "the signatures are LAPACK's")]

mod blas;
mod decompositions;

use std::ffi::{c_char, c_int};
use std::slice::{from_raw_parts, from_raw_parts_mut};

use super::Triangle;
#[cfg(test)]
pub(super) use {blas::*, decompositions::*};

/// A matrix of `rows` × `columns` entries with leading dimension `ld`, as a slice from its first to its last entry.
///
/// # Safety
/// These entries are readable and not written meanwhile.
unsafe fn matrix<'a>(start: *const f64, rows: usize, columns: usize, ld: usize) -> &'a [f64] {
    let length = extent(rows, columns, ld);
    // SAFETY: the caller guarantees the entries; an empty slice needs none.
    if length == 0 { &[] } else { unsafe { from_raw_parts(start, length) } }
}

/// As [`matrix`], but writable.
///
/// # Safety
/// These entries are readable and writable, and no other reference to them exists meanwhile.
unsafe fn matrix_mut<'a>(start: *mut f64, rows: usize, columns: usize, ld: usize) -> &'a mut [f64] {
    let length = extent(rows, columns, ld);
    // SAFETY: the caller guarantees the entries; an empty slice needs none.
    if length == 0 { &mut [] } else { unsafe { from_raw_parts_mut(start, length) } }
}

fn extent(rows: usize, columns: usize, ld: usize) -> usize {
    if rows == 0 || columns == 0 { 0 } else { (columns - 1) * ld + rows }
}

fn size(value: c_int) -> usize {
    usize::try_from(value).unwrap_or(0)
}

fn stride(value: c_int) -> usize {
    assert!(value > 0, "a stride of {value} is not supported");
    size(value)
}

fn triangle(letter: c_char) -> Triangle {
    let known = Triangle::from_letter(letter as u8);
    assert!(known.is_some(), "uplo must be U or L");
    known.unwrap_or(Triangle::Upper)
}

fn transposed(letter: c_char) -> bool {
    !(letter as u8).eq_ignore_ascii_case(&b'N')
}

fn is(letter: c_char, wanted: u8) -> bool {
    (letter as u8).eq_ignore_ascii_case(&wanted)
}
