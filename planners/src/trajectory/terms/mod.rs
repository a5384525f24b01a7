//! Costs and constraints of trajectory problems.

mod distance_cost;
mod mean_speed;

pub use distance_cost::{DistanceCost, DistancePrice};
pub use mean_speed::MeanSpeed;
