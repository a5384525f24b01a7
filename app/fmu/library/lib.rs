//! The shared library of an FMU: a thermal network and its weather behind the C functions of FMI 2.0 and 3.0 (co-simulation).
//!
//! It names nothing but the standard library, and is compiled by `build.rs` of this package. What it simulates is in the file
//! `resources/plant.txt` of the FMU, which the exporter writes. One library serves both versions: an importer calls the
//! functions of the version that the description states. The library has no global state, so a process may have any number of
//! instances.
//!
//! ```text
//! exports, fmi2, fmi3 -> calls -> instance -> plant
//!                              -> snapshot ↗
//! ```
//!
//! The functions of FMI take pointers and are called by programs in any language, so they are unsafe by nature. All of that is
//! in [`exports`], [`fmi2`], [`fmi3`], [`calls`] and [`logger`]; the rest is safe code. Each function catches panics.

mod calls;
mod exports;
mod fmi2;
mod fmi3;
mod instance;
mod location;
mod logger;
mod plant;
mod snapshot;
mod unsupported;

pub use exports::*;
pub use fmi2::*;
pub use fmi3::*;
pub use logger::LogMessage;
pub use unsupported::*;
