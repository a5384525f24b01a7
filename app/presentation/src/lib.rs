//! What people see of a run: recordings for Rerun, drawings, pages, figures and reports.
//!
//! Everything here is made from the plain values of [`interplay_simulation`]: its frames and its report.

mod curved_road;
pub mod figures;
mod network_lines;
pub mod page;
pub mod plot;
pub mod record;
pub mod report;
pub mod shell;
