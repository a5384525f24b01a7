//! A BOPTEST test case as the plant: on a server, through its HTTP interface, or as an FMU that runs locally.
//!
//! ```text
//! select -> step -> scenario | initialize -> measurements        forecast -> Foreseen
//! advance, once a step                                           results, kpi -> Benchmark
//! ```
//!
//! Both are a [`api::Bench`], which answers the same requests. The heat of a zone becomes the inputs that the scenario maps to
//! it; all other inputs stay those of the case's own controller. At the end, Interplay reads the indicators of the case and
//! computes them again from the measurements. `docs/guide/foreign-plants.md` describes the settings.

mod api;
mod boptest_error;
mod fmu;
mod forecast;
mod http;
mod indicators;
mod plant;

pub use boptest_error::BoptestError;
pub use plant::BoptestPlant;
