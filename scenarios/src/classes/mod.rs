//! The size of a scenario, and the classes of its vehicles.

mod class;
mod scale;

pub use class::VehicleClass;
pub use scale::{NamedScale, ScenarioScale};
