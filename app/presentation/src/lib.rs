//! What people see of a run: recordings for Rerun, drawings, pages, figures and reports.
//!
//! Everything here is made from the plain values of [`interplay_simulation`]: its frames and its report.
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
mod light_shapes;
mod nearest;
mod network_lines;
pub mod page;
mod palette;
mod passing_words;
pub mod plot;
pub mod record;
mod rectangle;
pub mod report;
mod road_shapes;
mod road_widths;
pub mod shell;
mod shown_extent;
mod signals;
pub mod stage;
mod wanted_temperature;
