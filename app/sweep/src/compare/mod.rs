//! Compares planners from the rows of a sweep, and two versions of the program.

mod building;
mod compared;
mod estimate;
mod figures;
mod pairs;
mod records;
mod versions;

pub use building::{BuildingDifference, BuildingFigures};
pub use estimate::{Estimate, Quantiles, Share, Split};
pub use figures::{Comparison, Figure, Figures, GroupBy, GroupFigures, NamedFigure, PlannerFigures, compare};
pub use pairs::{MetricSplit, MetricSplits, PairedDifference};
pub use versions::{VersionComparison, VersionGroup, compare_versions};
