//! Runs a functional mock-up unit (FMI 2.0, co-simulation and model exchange) in a separate process and exchanges lines of JSON with it.
//!
//! ```text
//! Unit::open: archive -> description          Host::start -> child process: serve -> library -> the unit's functions
//!                                             Host::ask   -> Request, a line -> HostAnswer, a line
//!                                             model exchange: serve -> exchange, events -> esdirk, steps -> library
//! ```
//!
//! The functions of a unit are foreign code: they may crash, hang, or write to the standard output. A child process therefore calls them,
//! and a crash is a [`HostError`] of the parent. The crate `fmi` (0.8) was considered: it binds both versions of the standard by `bindgen`,
//! which needs a Clang library at build time, and it loads the unit into the process that calls it. This crate needs only some twenty
//! functions of one version, which `library` declares.
//!
//! `unsafe` is allowed in `library`, which calls the unit, and in `standard_output`, which separates the unit's output from the answers.

#![allow(missing_docs, reason = "only this workspace uses the crate; a comment says what a name and its type do not")]

mod archive;
mod description;
mod error;
mod esdirk;
mod exchange;
mod host;
mod library;
mod linear;
mod protocol;
mod serve;
mod standard_output;
mod unit;

pub use description::{Causality, Description, Shape, UnitVariable, VariableKind};
pub use error::HostError;
pub use host::{Host, HostProgram};
pub use protocol::{HostAnswer, Request, Values};
pub use serve::serve;
pub use unit::Unit;
