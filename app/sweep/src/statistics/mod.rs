//! Statistics of samples.

mod bootstrap;
mod holm;
mod quantile;
mod sign_test;
mod wilson;

pub(crate) use bootstrap::mean_interval;
pub(crate) use holm::holm;
pub(crate) use quantile::{median, quantile};
pub(crate) use sign_test::sign_test;
pub(crate) use wilson::wilson_interval;
