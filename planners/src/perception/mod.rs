//! What a driver senses of the other vehicles, and what it believes about their drivers.

pub mod belief;
mod seen_motion;
pub mod sensing;

pub use seen_motion::SeenMotion;
