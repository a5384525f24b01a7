//! Many runs from one plan, one row each, and the comparison of planners from these rows.
//!
//! ```text
//! plan -> runs, each with a key -> journal, a line a run -> rows sorted by key, in one Parquet file a shard -> merged -> compared
//! ```
//!
//! The key of a run is a digest of all that determines its result, so a run that is in a journal is not made again:
//! a sweep that was killed continues, and a bigger sweep reuses the rows of a smaller one. Shards divide the keys and
//! are independent of one another.
//!
//! ```
//! use interplay_scenarios::SweepPlan;
//! use interplay_sweep::compare::{GroupBy, compare};
//! use interplay_sweep::{Shard, SweepOptions, sweep};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = tempfile::tempdir()?;
//! let text = "scenario = ['lane-change/front-nice']\nplanner = ['idm', 'conservative']\nsamples = 2\n\
//!     jitter = { speed_mps = 0.1 }\nset = { duration_s = 2.0, expect = {} }\n";
//! let plan = SweepPlan::from_text("two planners", text, folder.path())?;
//! let options = SweepOptions {
//!     folder: folder.path(),
//!     shard: Shard::WHOLE,
//!     keep: None,
//!     trajectories: false,
//!     checked: &|| (),
//!     begin: &|_, _| (),
//!     advance: &|| (),
//! };
//! assert_eq!(sweep(&plan, &options)?.made, 4);
//! assert_eq!(sweep(&plan, &options)?.made, 0, "all rows exist already");
//!
//! let figures = compare(folder.path(), Some("idm"), GroupBy::Scenario, plan.metrics())?;
//! assert_eq!(figures.runs, 4);
//! # Ok(())
//! # }
//! ```

mod column;
pub mod compare;
mod error;
mod journal;
mod journal_line;
mod key;
mod measure;
mod merge;
mod people;
mod people_rows;
mod row;
mod shard;
mod statistics;
mod sweep;

pub use error::SweepError;
pub use interplay_tables::{
    DetectorWriter, RowTable, SeriesWriter, TableColumn, TableError, TableFile, TableFormat, TableFormatError,
    TrajectoryWriter,
};
pub use key::{RunKey, program_version};
pub use merge::{MergedSweep, merge};
pub use people::{PeopleRows, PersonRun};
pub use row::SweepRow;
pub use shard::{Shard, ShardError};
pub use statistics::stratified_mean_interval;
pub use sweep::{KeepRecording, RUNS_FILE, SweepOptions, SweepOutcome, check, sweep, sweep_unless};
