//! The simulation: a scenario becomes an ECS world, is run, and is measured.
//!
//! ```text
//! scenario -> entities -> sense -> predict -> plan -> act -> physics | climate -> measure -> record -> report
//! ```
//!
//! A [`Simulation`] is stepped from outside; [`run`](run::run) steps it to its end. The loop is one visible list in [`phases`]; each phase is one file. Who wants to see
//! the ticks of a run implements [`Watcher`](watch::Watcher).

pub mod act;
pub mod climate;
pub mod components;
pub mod day;
mod external;
pub mod frame;
pub mod measure;
pub mod phases;
pub mod physics;
pub mod plan;
pub mod predict;
pub mod report;
pub mod run;
mod saved_run;
pub mod sense;
mod simulation;
mod snapshot;
pub mod spawn;
pub mod time_points;
pub mod watch;
pub mod why;
mod world_state;
pub mod worst_zones;

pub use saved_run::SavedRunError;
pub use simulation::Simulation;
pub use snapshot::Snapshot;
pub use world_state::NotCopied;
