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
pub(crate) mod encounter;
pub mod external;
mod foreign_driver;
pub mod game;
pub mod human;
pub mod idm;
pub mod inputs;
pub mod lanes;
pub mod nash;
pub mod negotiation;
pub(crate) mod receding_horizon;
pub mod recorded;
pub mod scripted;
pub mod walker;

pub use drive::{Drive, DriverKind};
pub use driver::Driver;
pub use driver_setting::DriverSettingError;
pub use foreign_driver::ForeignDriver;
