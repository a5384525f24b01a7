//! The scenario as it is run: plain values in SI units, whatever file they came from.
//!
//! A [`Scenario`](scenario::Scenario) that came from [`load`](crate::load) has been checked and satisfies all rules of the format.
//! Types that both files and runs use are here; types that only files use are in `format`.

pub(crate) mod building;
pub(crate) mod classes;
pub(crate) mod derived;
pub(crate) mod expectations;
pub(crate) mod metric;
pub(crate) mod remark;
pub(crate) mod scenario;
pub(crate) mod traffic;
