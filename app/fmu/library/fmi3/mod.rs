//! The functions of FMI 3.0 (`fmi3Functions.h`).

mod interface;
mod state;
mod unsupported;

pub use interface::*;
pub use state::*;
pub use unsupported::*;
