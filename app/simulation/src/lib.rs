//! The simulation: a scenario becomes an ECS world, is run, and is measured.
//!
//! ```text
//! scenario -> entities -> sense -> predict -> plan -> act -> physics | climate -> measure -> record -> report
//! ```
//!
//! A [`Simulation`] is stepped from outside; [`run`](run::run) steps it to its end. The loop is one visible list in [`phases`]; each
//! phase is one file. Who wants to see the ticks of a run implements [`Watcher`](watch::Watcher).
//!
//! ```
//! use interplay_planners::Input;
//! use interplay_scenarios::{Override, load};
//! use interplay_simulation::Simulation;
//!
//! // The ego is driven from here, the others by our human drivers.
//! let external = Override::Set("vehicle.ego.driver={ kind = 'external' }".to_owned());
//! let mut world = Simulation::new(&load("lane-change/front-nice", &[external])?)?;
//! while world.time_s() < 1.0 {
//!     let seen = world.observe("ego")?.scene;
//!     assert_eq!(seen.others.len(), 2);
//!     world.apply("ego", Input { acceleration_mps2: 0.5, steering_rad: 0.0 })?;
//!     world.step()?;
//! }
//! let report = world.finish()?;
//! assert!(report.collisions.is_empty() && report.vehicles[0].last.speed_mps > 1.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod act;
pub mod climate;
pub mod components;
pub mod day;
mod detail;
pub mod driven;
pub mod environment;
mod external;
pub mod frame;
pub mod measure;
mod not_copied;
pub mod phases;
pub mod physics;
pub mod plan;
pub mod predict;
mod presence;
pub mod report;
pub mod run;
mod run_error;
pub mod sense;
mod simulation;
pub mod spawn;
pub mod standing;
pub mod time_points;
pub mod watch;
pub mod whole_run;
pub mod why;
mod world_state;
pub mod worst_zones;

/// The lines of the README that use the library are compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

pub use not_copied::NotCopied;
pub use simulation::{SavedRunError, Simulation, Snapshot, ZoneNow};
