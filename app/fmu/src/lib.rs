//! Export of a building as a functional mock-up unit (FMU): its network and weather for programs that import FMI 2.0 or 3.0.
//!
//! ```text
//! scenario -> discrete network, weather -> plant.txt ┐
//!          -> variables -> modelDescription.xml      ├ archive
//!             library (compiled by build.rs)         ┘
//! ```
//!
//! The heat of each zone is an input; occupancy, sun and outdoor temperature are those of the scenario and its seed. The shared
//! library is built from `library/` and contained in this crate as bytes.
//!
//! ```no_run
//! let scenario = interplay_scenarios::load("building/four-room-pid", &[])?;
//! std::fs::write("four-rooms.fmu", interplay_fmu::export(&scenario, interplay_fmu::FmiVersion::Two)?)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![allow(missing_docs, reason = "only this workspace uses the crate; a comment says what a name and its type do not")]

mod description;
mod error;
mod export;
mod resources;

pub use description::FmiVersion;
pub use error::FmuError;
pub use export::export;
