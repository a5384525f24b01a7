//! The simulation: a scenario becomes an ECS world, is run, and is measured.
//!
//! ```text
//! scenario -> entities -> sense -> predict -> plan -> act -> physics | climate -> measure -> record -> report
//! ```
//!
//! [`run`](run::run) does all of it. The loop is one visible list in [`phases`]; each phase is one file. Who wants to see
//! the ticks of a run implements [`Watcher`](watch::Watcher).

pub mod act;
pub mod climate;
pub mod components;
pub mod day;
pub mod frame;
pub mod measure;
pub mod phases;
pub mod physics;
pub mod plan;
pub mod predict;
pub mod report;
pub mod run;
pub mod sense;
pub mod spawn;
pub mod time_points;
pub mod watch;
pub mod why;
pub mod worst_zones;
