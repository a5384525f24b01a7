//! The plant on which the equipment's heat acts: the network of the scenario, or another program.
//!
//! ```text
//! start: temperatures at the first midnight        step: heat, people, weather -> temperatures at the step's end
//! ```
//!
//! The other program answers lines of JSON through a socket, or the requests of BOPTEST. [`ThermalPlant`] is the
//! interface. The controller does not see the plant: it knows only the believed network.

mod answer;
mod boptest;
mod error;
mod interface;
mod lines;
mod socket;
mod walls;

pub use boptest::{BoptestError, BoptestPlant};
pub use error::PlantError;
pub use interface::{Benchmark, Foreseen, StepInputs, ThermalPlant};
pub use socket::{SocketPlant, SocketPlantStart};
pub use walls::NetworkPlant;
