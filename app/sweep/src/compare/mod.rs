//! What the rows of a sweep say of the planners, and what two versions of the program do differently.

mod building;
mod compared;
mod estimate;
mod figures;
mod pairs;
mod records;
mod split;
mod versions;

pub use building::{BuildingDifference, BuildingFigures};
pub use estimate::{Estimate, Quantiles, Share};
pub use figures::{Comparison, Figure, Figures, GroupBy, GroupFigures, NamedFigure, PlannerFigures, compare};
pub use pairs::{MetricSplit, MetricSplits, PairedDifference};
pub use split::Split;
pub use versions::{VersionComparison, VersionGroup, compare_versions};
