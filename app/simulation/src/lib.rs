//! Interplay: a simulator for agents that must interact.
//!
//! ```text
//! scenario file -> Scenario -> entities -> sense -> predict -> plan -> act -> physics | climate -> measure -> record -> report
//! ```
//!
//! [`run`](run::run) does all of it. The loop is one visible list in [`phases`]; each phase is one file.

pub mod act;
pub mod cli;
pub mod climate;
pub mod components;
pub mod day;
pub mod figures;
pub mod frame;
pub mod measure;
pub mod moments;
pub mod page;
pub mod phases;
pub mod physics;
pub mod plan;
pub mod plot;
pub mod predict;
pub mod record;
pub mod report;
pub mod run;
pub mod sense;
mod shell;
pub mod spawn;
pub mod watch;
