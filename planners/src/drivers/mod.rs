//! The drivers, one module each.
//!
//! [`Driver`] lists them with the word that a scenario file uses for each. The settings of a driver implement
//! [`DriverKind`]; they make a [`Drive`], which plans. What several drivers share stands beside them.

pub mod bayesian;
pub mod conservative;
pub mod contingency;
pub mod cooperative;
pub(crate) mod drive;
mod driver;
mod driver_setting;
pub mod external;
pub mod game;
pub mod human;
pub mod idm;
pub mod inputs;
pub mod lanes;
pub mod nash;
pub mod negotiation;
pub(crate) mod partner_choice;
pub mod reaction;
pub(crate) mod receding_horizon;
pub mod recorded;
pub mod scripted;
mod seen_motion;
pub mod walker;

pub use drive::{Drive, DriverKind, StandardReplacement};
pub use driver::{Driver, ForeignDriver};
pub use driver_setting::DriverSettingError;
pub use seen_motion::SeenMotion;
