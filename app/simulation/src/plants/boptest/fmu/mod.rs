//! A test case that is an FMU on this machine: it runs in a process of its own, and answers as a server of BOPTEST would.
//!
//! ```text
//! wrapped.fmu -> Unit -> Host (a child process)      resources/*.csv -> CaseData: forecasts, prices, bounds
//!                        FmuBench: initialize, advance, results
//! ```
//!
//! It has no indicators of BOPTEST: those that we compute from its results are the report's.

mod bench;
mod data;

pub use bench::FmuBench;
