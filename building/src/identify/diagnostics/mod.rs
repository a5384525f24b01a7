//! Diagnostics of an estimate: tests whether the data determine it, and whether the residuals are white.

mod chi_squared;
mod periodogram;
mod whiteness;

pub use whiteness::{Confidence, LjungBox, ParameterVerdict, Whiteness};

pub(super) use chi_squared::survival;
pub(super) use whiteness::{STANDARD_ERRORS_OF_95_PERCENT, judge, whiteness};
