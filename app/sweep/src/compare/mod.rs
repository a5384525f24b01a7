//! What the rows of a sweep say of the planners, and what two versions of the program do differently.

mod figures;
mod pairs;
mod records;
mod versions;

pub use figures::{Comparison, Estimate, GroupBy, GroupFigures, PlannerFigures, Quantiles, Share, compare};
pub use pairs::{PairedDifference, Split};
pub use versions::{VersionComparison, VersionGroup, compare_versions};
