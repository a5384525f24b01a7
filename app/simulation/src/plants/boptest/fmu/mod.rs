//! A test case that is an FMU on this machine: it runs in a separate process, and answers like a BOPTEST server.
//!
//! ```text
//! wrapped.fmu -> Unit -> Host (a child process)      resources/*.csv -> CaseData: forecasts, prices, bounds
//!                        FmuBench: initialize, advance, results
//! ```
//!
//! BOPTEST's own indicators are not available; the report contains those that Interplay computes from the results.

mod bench;
mod data;

pub use bench::FmuBench;
