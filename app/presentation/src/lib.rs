//! Output of runs: recordings for Rerun, animations, figures, pages and reports.
//!
//! All output is made from the frames and the report of [`interplay_simulation`].
//!
//! ```
//! use interplay_presentation::report::summary;
//! use interplay_scenarios::load;
//! use interplay_simulation::run::run;
//!
//! let scenario = load("lane-change/front-nice", &[])?;
//! let report = run("lane-change/front-nice", &scenario, Vec::new())?;
//! assert!(summary(&scenario.title, &report).contains("12.0 s simulated"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![allow(missing_docs, reason = "only this workspace uses the crate; a comment says what a name and its type do not")]

pub mod animation;
mod body;
mod camera;
mod curved_road;
mod edge_mark;
pub mod figures;
mod network_lines;
pub mod page;
mod palette;
mod passing_words;
pub mod plot;
pub mod record;
mod rectangle;
pub mod report;
mod requests;
mod road_shapes;
pub mod shell;
mod shown_extent;
mod signals;
pub mod stage;
