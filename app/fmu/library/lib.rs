//! The shared library of an FMU: a thermal network and its weather behind the C functions of FMI 2.0 (co-simulation).
//!
//! It names nothing but the standard library, and is compiled by `build.rs` of this package. What it simulates is in the file
//! `resources/plant.txt` of the FMU, which the exporter writes.
//!
//! The functions of FMI take pointers and are called by programs in any language, so they are unsafe by nature. All of that is
//! in [`interface`] and [`callbacks`]; the rest is safe code. No panic crosses the border: each function catches it.

mod callbacks;
mod instance;
mod interface;
mod location;
mod plant;
mod unsupported;

pub use interface::*;
pub use unsupported::*;
