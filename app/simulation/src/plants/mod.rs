//! The plant on which the equipment's heat acts: our own network, or another program.
//!
//! ```text
//! start: temperatures at the first midnight        step: heat, people, weather -> temperatures at the step's end
//! ```
//!
//! The other program answers lines of JSON behind a socket, or the requests of BOPTEST. [`ThermalPlant`] is the interface. The controller never sees it: it knows the believed network only.

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
