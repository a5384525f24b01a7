//! Reports as texts, for people and for build servers.

mod building;
mod columns;
mod comparison;
mod crowd;
mod identification;
mod identified_scenario;
mod identified_summary;
mod junit;
mod prediction;
mod suite;
mod summary;
mod why;

pub use comparison::{ShownFigures, comparison, comparison_page, version_comparison, version_comparison_page};
pub use identification::identification;
pub use identified_scenario::{Believed, identified_scenario};
pub use identified_summary::identified_summary;
pub use junit::junit;
pub use prediction::{driving, prediction};
pub use suite::{Case, CaseError, table};
pub use summary::summary;
pub use why::why;
