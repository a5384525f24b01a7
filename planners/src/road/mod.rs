//! The road that a vehicle uses: its direction and its edges.
//!
//! A [`Corridor`] is a straight road. Curved roads are lanes of a [`network`], each with a [`CentreLine`] and a [`Profile`] of
//! its width.

mod axes;
pub mod centre_line;
mod corridor;
pub mod network;
mod profile;

pub use axes::Axes;
pub use centre_line::CentreLine;
pub use corridor::{Corridor, LaneEnd};
pub use network::Route;
pub use profile::{Profile, ProfileError, Stretch};
