//! The road that a vehicle uses: its direction and its edges.

mod axes;
pub mod centre_line;
mod corridor;
mod spline;

pub use axes::Axes;
pub use centre_line::CentreLine;
pub use corridor::{Corridor, LaneEnd};
