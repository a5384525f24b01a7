//! Diagnostics of an estimate: tests whether the data determine it, and whether the residuals are white.

mod chi_squared;
mod periodogram;
mod verdict;
mod whiteness;

pub use verdict::{Confidence, ParameterVerdict};
pub use whiteness::{LjungBox, Whiteness};

pub(super) use chi_squared::survival;
pub(super) use verdict::{STANDARD_ERRORS_OF_95_PERCENT, judge};
pub(super) use whiteness::whiteness;
