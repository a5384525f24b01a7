//! The size of a scenario, and the classes of its vehicles.

mod class;
mod scale;

pub use class::VehicleClass;
pub(crate) use scale::FULL_SCALE;
pub use scale::{NamedScale, ScenarioScale};
