//! Interplay: what both halves of the project, the planners and the building, and the scenarios share.
//!
//! - settings: [`setting`] holds them to the [`bounds`] on their fields, [`json_schema`] reads what stands there, and [`units`]
//!   reads the unit of a number from its key
//! - [`spelling`]: the known word that an unknown one was probably meant to be
//! - [`foreign`]: settings of kinds that other crates provide
//! - [`cell`]: cells of tables, as errors show them
//! - [`random`]: the random streams of runs, the same on every machine
//!
//! ```
//! use interplay_common::{spelling, units};
//!
//! assert_eq!(units::unit_of("speed_mps"), Some("m/s"));
//! assert_eq!(spelling::nearest("spede_mps", ["speed_mps", "heading_deg"]), Some("speed_mps"));
//! ```

pub mod bounds;
pub mod cell;
pub mod foreign;
pub mod json_schema;
pub mod random;
pub mod setting;
pub mod spelling;
pub mod units;
