//! Statistics of samples.

mod intervals;

pub(crate) use intervals::{holm, mean_interval, median, quantile, sign_test, wilson_interval};
