//! What people see of a run: recordings for Rerun, drawings, pages, figures and reports.
//!
//! Everything here is made from the plain values of [`interplay_simulation`]: its frames and its report.
//!
//! ```
//! use interplay_presentation::report::summary;
//! use interplay_scenarios::{Override, load};
//! use interplay_simulation::run::run;
//!
//! let short = ["duration_s=0.5", "expect={}"].map(|change| Override::Set(change.to_owned()));
//! let scenario = load("lane-change/front-nice", &short)?;
//! let report = run("short", &scenario, Vec::new())?;
//! assert!(summary(&scenario.title, &report).contains("0.5 s simulated"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod animation;
mod answer;
mod body_shape;
mod body_style;
mod camera;
mod contact;
mod curved_road;
mod edge_mark;
mod extent;
pub mod figures;
mod font;
mod lane_change;
mod network_lines;
pub mod page;
mod palette;
mod passing_words;
pub mod plot;
pub mod record;
mod rectangle;
pub mod report;
mod road_shapes;
pub mod shell;
mod shown_extent;
mod signals;
mod wanted_temperature;
