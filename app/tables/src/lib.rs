//! Tables of rows, as Parquet or comma-separated values, and the tables that a run writes while it advances: trajectories of vehicles
//! ([`TrajectoryWriter`]), counts of detectors ([`DetectorWriter`]), and series of the building ([`SeriesWriter`]).

#![allow(missing_docs, reason = "only this workspace uses the crate; a comment says what a name and its type do not")]

mod cell;
mod detectors;
mod row_file;
mod series;
mod table;
mod trajectories;

pub use cell::{Cell, ColumnKind, TableError, TableSchema};
pub use detectors::DetectorWriter;
pub use row_file::{TableFile, TableFormat, TableFormatError};
pub use series::SeriesWriter;
pub use table::{RowTable, TableColumn, TableReader, TableWriter};
pub use trajectories::TrajectoryWriter;
