//! Compares planners from the rows of a sweep, and two versions of the program.

mod building;
mod compared;
mod figures;
mod pairs;
mod records;

pub use building::{BuildingDifference, BuildingFigures};
pub use figures::{Comparison, Figure, Figures, GroupBy, GroupFigures, NamedFigure, PlannerFigures, compare};
pub use pairs::{Estimate, MetricSplit, MetricSplits, PairedDifference, Quantiles, Share, Split};
pub use records::{VersionComparison, VersionGroup, compare_versions};
