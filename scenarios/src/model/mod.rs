//! The scenario as it is run: plain values in SI units, whatever file they came from.
//!
//! A [`Scenario`](scenario::Scenario) that came from [`load`](crate::load) has been checked: it keeps every promise of the format.
//! Values that a file states and a run takes as they are stand here; what only a file has is in `format`.

pub(crate) mod budget_limits;
pub(crate) mod building;
pub(crate) mod classes;
pub(crate) mod derived;
pub(crate) mod expectations;
pub(crate) mod metric;
pub(crate) mod remark;
pub(crate) mod scenario;
pub(crate) mod traffic;
