//! The functions of FMI 2.0 (`fmi2Functions.h`).

mod interface;
mod state;
mod unsupported;

pub use interface::*;
pub use state::*;
pub use unsupported::*;
