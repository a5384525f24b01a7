//! Interplay: planners for vehicles that interact.
//!
//! Pure functions of plain values: a planner is given a [`Scene`] (what one vehicle knows at a moment) and answers with a
//! [`Plan`] or a [`PlanError`]. Nothing here knows of time, files, physics or pictures.
//!
//! - nouns: [`State`], [`Input`], [`Trajectory`], [`Body`], [`SafetyEllipse`], [`Corridor`], [`Scene`], [`Plan`]
//! - [`dynamics`]: vehicle models with derivatives
//! - [`predict`]: what the others will do
//! - [`mpc`]: one trajectory optimiser
//! - drivers, one folder each: [`human`], [`idm`], [`scripted`], [`conservative`], [`cooperative`], [`negotiation`],
//!   [`bayesian`], [`game`];
//!   [`Driver`] lists them
//! - [`traffic`]: the closed loop of all vehicles on a road
//!
//! Sines, exponentials and the like come from `libm`, so that results are the same bit for bit on every machine.
//!
//! Equation numbers are those of C. Peng, *Optimization Based Control for Multi-agent System with Interaction* (Berkeley,
//! 2019); "corrected" marks where the printed equation is in error.

mod activity;
mod axes;
pub mod bayesian;
pub mod conservative;
pub mod cooperative;
pub mod diagnostic;
mod driver;
pub mod dynamics;
mod encounter;
#[cfg(test)]
mod fixture;
mod footprint;
pub mod game;
pub mod human;
pub mod idm;
pub mod mpc;
pub mod negotiation;
mod plan;
pub mod predict;
mod road;
mod scene;
pub mod scripted;
mod solo;
mod state;
mod steering;
pub mod traffic;

pub use axes::Axes;
pub use diagnostic::Diagnostic;
pub use driver::{Driver, Planner};
pub use footprint::{Body, EllipticalDistance, SafetyEllipse};
pub use plan::{Plan, PlanError, Proposal};
pub use road::{Clearance, Corridor, LaneEnd};
pub use scene::{Agent, Goal, Scene};
pub use state::{Input, State, Trajectory};
