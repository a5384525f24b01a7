//! The simulation: a scenario becomes an ECS world, is run, and is measured.
//!
//! ```text
//! scenario -> entities -> sense -> predict -> plan -> act -> physics | climate -> measure -> record -> report
//! ```
//!
//! The caller steps a [`Simulation`]; [`run`](run::run) steps it to its end. The loop is one visible list in [`phases`]; each
//! phase is one file. A [`Watcher`](watch::Watcher) receives the ticks of a run.
//!
//! ```
//! use interplay_planners::Input;
//! use interplay_scenarios::{Override, load};
//! use interplay_simulation::Simulation;
//!
//! // The caller drives the ego, and our human drivers drive the other vehicles.
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

pub mod climate;
pub mod driven;
pub mod environment;
pub mod measure;
pub mod phases;
pub mod physics;
pub mod plants;
pub mod report;
pub mod run;
mod simulation;
mod state;
pub mod why;

/// Compiles and runs the Rust examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

pub use phases::{act, plan, predict, sense, time_points, watch};
pub use simulation::{SavedRunError, Simulation, SimulationBuilder, Snapshot, ZoneNow, spawn};
pub use state::detail::NotCopied;
pub use state::{components, day, frame, standing, whole_run, worst_zones};
