//! What the heat of the equipment acts on: our own network, or another program behind a socket.
//!
//! ```text
//! start: temperatures at the first midnight        step: heat, people, weather -> temperatures at the step's end
//! ```
//!
//! [`ThermalPlant`] is the interface. The controller never sees it: it knows the believed network only.

mod answer;
mod error;
mod interface;
mod lines;
mod network;
mod socket;
mod walls;

pub use error::PlantError;
pub use interface::{StepInputs, ThermalPlant};
pub use network::NetworkPlant;
pub use socket::{SocketPlant, SocketPlantStart};
