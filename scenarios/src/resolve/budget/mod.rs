//! The estimated work of a scenario, computed while it is loaded, and its limits.
//!
//! A run that would take hours or fill a disk is refused before it begins, and the error names the key that makes it large.
//! All numbers follow from the scenario alone, so the answer is the same on every machine.

mod check;
mod cost;
mod plan_time;

pub use cost::RunCost;

pub(crate) use check::{check, check_all};
