//! Statistics of samples.

mod intervals;
mod quantile;
mod significance;

pub(crate) use intervals::{mean_interval, wilson_interval};
pub(crate) use quantile::{median, quantile};
pub(crate) use significance::{holm, sign_test};
