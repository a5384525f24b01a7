//! The road that a vehicle uses: its direction and its edges.

mod axes;
mod corridor;

pub use axes::Axes;
pub use corridor::{Corridor, LaneEnd};
