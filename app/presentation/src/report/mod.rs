//! Reports as texts: for a person, for a build server.

mod building;
mod columns;
mod identification;
mod identified_scenario;
mod junit;
mod suite;
mod summary;
mod why;

pub use identification::identification;
pub use identified_scenario::identified_scenario;
pub use junit::junit;
pub use suite::{Case, table};
pub use summary::summary;
pub use why::why;
