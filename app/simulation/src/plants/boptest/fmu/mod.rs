//! A test case that is an FMU on this machine: it runs in a separate process, and answers like a BOPTEST server.
//!
//! ```text
//! wrapped.fmu -> Unit -> Host (a child process)      resources/*.csv -> CaseData: forecasts, prices, bounds
//!                        FmuBench: initialize, advance, results
//! ```
//!
//! It has no indicators of BOPTEST; the report contains those that we compute from its results.

mod bench;
mod data;

pub use bench::FmuBench;
