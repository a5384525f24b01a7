//! A test case of BOPTEST as the plant, through its interface over HTTP.
//!
//! ```text
//! select -> step -> scenario | initialize -> measurements        advance, once a step        results, kpi -> Benchmark
//! ```
//!
//! The heat of a zone becomes the inputs that the scenario maps to it; all other inputs stay those of the case's own controller. At the end
//! its indicators are read, and computed again from what it measured. `docs/foreign-plants.md` describes the settings.

mod api;
mod http;
mod indicators;
mod plant;

pub use plant::BoptestPlant;
