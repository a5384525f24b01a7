//! Statistics of samples.

mod intervals;

pub use intervals::stratified_mean_interval;
pub(crate) use intervals::{holm, mean_interval, median, quantile, sign_test, wilson_interval};
