//! Sequential quadratic programming.

mod line_search;
mod linearize;
mod optimiser;
mod other_side;
mod starts;
mod warm_start;

pub use linearize::{add_curvature, drop_curvature, linearise};
pub use optimiser::{DescentError, Optimiser, Optimum, Statistics, Tolerances};
pub use warm_start::Memory;
