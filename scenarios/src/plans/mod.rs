//! Plans of many runs: scenarios, times drivers of the other vehicles, times values that vary, times planners of the ego.
//!
//! A plan is a TOML file. It is parsed into the same tree with places as a scenario, and checked against a schema of its own.
//! Each run is the tree of its scenario with the plan's values merged into it, and is assembled and checked like any scenario; so
//! every fault of a value is located in the plan.
//!
//! The runs of one sample differ in the planner only: all planners get the same values and the same seed (common random
//! numbers). A drawn value depends only on the plan's seed, the path and the sample, so that another path, planner
//! or scenario, and more samples, leave existing runs unchanged; only in a Latin hypercube the number of samples changes all
//! values.

pub(crate) mod plan_file;
pub(crate) mod standard_changes;

mod assignment;
mod conflicts;
mod factor;
mod names;
mod plan;
mod read;
mod refusals;
mod without_effect;

pub use names::names_matching;
pub use plan::{SweepPlan, SweepPoint};
pub use read::{embedded_plans, first_planner};
pub use refusals::RunRefusals;
